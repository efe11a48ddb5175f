#include "estimator/undistortion.h"

#include <Eigen/LU>
#include <cmath>
#include <numeric>
#include <utility>

#include "estimator/noise_scale.h"
#include "stats/median_ratio.h"

namespace rcme {

std::optional<UndistortedMatch> UndistortMatch(const Lens& lens1, const Lens& lens2,
                                               const Correspondence& distorted) {
  const std::optional<Eigen::Vector2d> x1_px = Undistort(lens1, distorted.x1_px),
                                       x2_px = Undistort(lens2, distorted.x2_px);
  if (!x1_px || !x2_px) return std::nullopt;
  const double area1 = std::abs(UndistortionJacobian(lens1, *x1_px).determinant()),
               area2 = std::abs(UndistortionJacobian(lens2, *x2_px).determinant());
  const double noise_ratio = std::sqrt(0.5 * (area1 + area2));
  if (!(noise_ratio > 0.0) || !std::isfinite(noise_ratio))
    return std::nullopt;  // coefficients beyond all sense
  return UndistortedMatch{{*x1_px, *x2_px}, noise_ratio};
}

UndistortedProblem UndistortProblem(const Lens& lens1, const Lens& lens2, MotionProblem distorted) {
  UndistortedProblem undistorted;
  if (lens1.model == LensModel::kPinhole && lens2.model == LensModel::kPinhole) {
    undistorted.kept.resize(distorted.matches.size());
    std::iota(undistorted.kept.begin(), undistorted.kept.end(), size_t{0});
    undistorted.problem = std::move(distorted);
    undistorted.problem.camera1 = lens1.camera;
    undistorted.problem.camera2 = lens2.camera;
    return undistorted;
  }
  MotionProblem& problem = undistorted.problem;
  problem.camera1 = lens1.camera;
  problem.camera2 = lens2.camera;
  std::vector<double> ratios;
  for (size_t i = 0; i < distorted.matches.size(); ++i) {
    const std::optional<UndistortedMatch> found = UndistortMatch(lens1, lens2, distorted.matches[i]);
    if (!found) continue;
    problem.matches.push_back(found->match);
    undistorted.kept.push_back(i);
    ratios.push_back(NoiseScaleAt(distorted, i) * found->noise_ratio);
    if (!distorted.match_quality.empty()) problem.match_quality.push_back(distorted.match_quality[i]);
  }
  problem.undistortion = {lens1, lens2, ratios.empty() ? 1.0 : ComputeMedian(ratios)};
  problem.sigma_px = distorted.sigma_px * problem.undistortion->noise_growth;
  problem.noise_scale = ComputeNoiseScale(std::move(ratios));
  problem.prior = std::move(distorted.prior);
  return undistorted;
}

void RestoreDistorted(const MotionProblem& problem, const std::vector<size_t>& kept, size_t num_distorted,
                      MotionEstimate* estimate) {
  estimate->sigma_estimated_px = InImagePixels(problem, estimate->sigma_estimated_px);
  estimate->sigma_estimated_sd_px = InImagePixels(problem, estimate->sigma_estimated_sd_px);
  for (int& inlier : estimate->inliers) inlier = static_cast<int>(kept[static_cast<size_t>(inlier)]);
  if (estimate->inlier_probabilities.empty()) return;
  std::vector<double> probabilities(num_distorted, 0.0);
  for (size_t i = 0; i < kept.size(); ++i) probabilities[kept[i]] = estimate->inlier_probabilities[i];
  estimate->inlier_probabilities = std::move(probabilities);
}

}  // namespace rcme
