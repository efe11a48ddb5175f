#include "estimator/linear_motion.h"

#include <cmath>
#include <vector>

namespace rcme {

Vector9d ComputeLinearModel(const RelativePose& pose) {
  return Vectorize(EssentialFromPose(pose)) / std::sqrt(2.0);
}

std::optional<LinearMotion> EstimateLinearMotion(const MotionProblem& problem) {
  std::vector<Eigen::Vector3d> rays1, rays2;
  for (const Correspondence& match : problem.matches) {
    rays1.push_back(problem.camera1.Ray(match.x1_px));
    rays2.push_back(problem.camera2.Ray(match.x2_px));
  }
  std::optional<LinearFit> fit = FitLinear(rays1, rays2);
  if (!fit) return std::nullopt;
  const EssentialProjection projection = ProjectToEssential(Matricize(fit->f));
  if (!projection.DeterminesDirection()) return std::nullopt;

  LinearMotion motion{std::move(*fit), PosesFromEssential(projection)};
  const Eigen::Matrix3d F =
      FundamentalFromEssential(Matricize(motion.fit.f), problem.camera1, problem.camera2);
  Eigen::VectorXd variances(problem.matches.size());
  for (size_t k = 0; k < problem.matches.size(); ++k) {
    variances(static_cast<Eigen::Index>(k)) = ConstraintVariance(F, problem.matches[k], problem.sigma_px);
  }
  motion.f_cov = CovarianceOfF(motion.fit.G, variances);
  return motion;
}

}  // namespace rcme
