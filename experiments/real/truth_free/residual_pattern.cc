#include "experiments/real/truth_free/residual_pattern.h"

#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "experiments/real/truth_free/twin.h"
#include "stats/order_statistic.h"

namespace rcme {

std::vector<double> ResidualSizes(const MotionProblem& problem, const MotionEstimate& estimate) {
  const double sigma_px = EstimateNoise(problem, estimate);
  const Eigen::Matrix3d F = ComputeFundamental(problem, estimate.cam2_from_cam1);
  std::vector<double> sizes;
  for (const int inlier : estimate.inliers) {
    const auto i = static_cast<size_t>(inlier);
    sizes.push_back(std::sqrt(SquaredSampsonDistance(F, problem.matches[i])) /
                    (sigma_px * NoiseScaleAt(problem, i)));
  }
  return sizes;
}

void PatternSum::Add(const MotionProblem& problem, const MotionEstimate& estimate) {
  if (estimate.status != MotionStatus::kOk || estimate.inliers.empty()) return;
  sum_log_sigma_ += std::log(EstimateNoise(problem, estimate));
  num_answers_ += 1.0;
  const std::vector<double> sizes = ResidualSizes(problem, estimate);
  sizes_.insert(sizes_.end(), sizes.begin(), sizes.end());
  products_ += SumProducts(problem, estimate);
}

ResidualPattern PatternSum::Take() const {
  std::vector<double> sizes = sizes_;
  const double far = ComputeQuantile(sizes, 0.95);
  return {std::exp(sum_log_sigma_ / num_answers_), far / ComputeQuantile(sizes, 0.5), products_};
}

}  // namespace rcme
