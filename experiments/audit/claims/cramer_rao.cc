#include "experiments/audit/claims/cramer_rao.h"

#include "estimator/uncertainty/motion_covariance.h"
#include "simulator/exact_match.h"

namespace rcme {

std::optional<Matrix5d> CramerRaoBound(const Case& made) {
  const MotionProblem& problem = made.problem();
  std::vector<Correspondence> exact;
  for (size_t i = 0; i < made.data.scene_point.size(); ++i) {
    if (!made.data.truth.is_inlier_true[i]) continue;
    const Eigen::Vector3d& point = made.scene.points_in_cam1[made.data.scene_point[i]];
    exact.push_back(PinholeMatch(made.scene, point));
  }
  if (exact.size() < 5) return std::nullopt;
  return FirstOrderMotionCovariance(made.pose_true(), problem.camera1, problem.camera2, exact,
                                    problem.sigma_px);
}

}  // namespace rcme
