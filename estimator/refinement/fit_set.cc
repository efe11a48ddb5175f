#include "estimator/refinement/fit_set.h"

#include <algorithm>

#include "estimator/geometry/triangulation.h"
#include "estimator/noise_scale.h"
#include "estimator/point_consistency.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// Whether the triangulated point lies behind a camera, and its parallax is too large to be noise around a
// point at infinity.
bool IsClearlyBehindACamera(const MotionProblem& problem, const RelativePose& pose,
                            const Correspondence& match, double sigma_px) {
  const Eigen::Vector3d ray1 = problem.camera1.Ray(match.x1_px);
  const Eigen::Vector3d ray2 = problem.camera2.Ray(match.x2_px);
  if (IsInFrontOfBothCameras(pose, ray1, ray2)) return false;
  const Eigen::Vector3d ray1_in_cam2 = pose.R * ray1;
  if (ray1_in_cam2.z() <= 0.0) return true;
  const double parallax_px = (problem.camera2.Project(ray1_in_cam2) - match.x2_px).norm();
  return parallax_px > 6.0 * sigma_px;
}

}  // namespace

std::vector<int> FindAgreeing(const MotionProblem& problem, const RefinedMotion& motion,
                              const std::vector<int>& fitted, double significance_level) {
  const auto model =
      UncertainFundamental::From(motion.cam2_from_cam1, motion.pose_cov, problem.camera1, problem.camera2);
  if (!model) return {};
  const double threshold = ChiSquareQuantile(1, 1.0 - significance_level);
  std::vector<int> agreeing;
  for (int i = 0; i < static_cast<int>(problem.matches.size()); ++i) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const MatchResidual residual = EvaluateResidual(*model, match);
    const bool is_fitted = std::binary_search(fitted.begin(), fitted.end(), i);
    const double sigma_px = problem.sigma_px * NoiseScaleAt(problem, static_cast<size_t>(i));
    const double variance = sigma_px * sigma_px + (is_fitted ? -1.0 : 1.0) * residual.motion_variance;
    if (residual.squared_distance > threshold * variance) continue;
    if (!IsClearlyBehindACamera(problem, motion.cam2_from_cam1, match, sigma_px)) agreeing.push_back(i);
  }
  return agreeing;
}

std::vector<int> SelectFitSet(const MotionProblem& problem, const RefinedMotion& motion,
                              const std::vector<int>& fitted) {
  const auto model =
      UncertainFundamental::From(motion.cam2_from_cam1, motion.pose_cov, problem.camera1, problem.camera2);
  std::vector<int> selected = FindAgreeing(problem, motion, fitted, kFitSignificance);
  if (!model || fitted.empty()) return selected;
  const double max_leverage = MaxLeverage(static_cast<int>(fitted.size()));
  std::erase_if(selected, [&](int i) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const double sigma_px = problem.sigma_px * NoiseScaleAt(problem, static_cast<size_t>(i));
    return EvaluateResidual(*model, match).motion_variance > max_leverage * sigma_px * sigma_px;
  });
  return selected;
}

}  // namespace rcme
