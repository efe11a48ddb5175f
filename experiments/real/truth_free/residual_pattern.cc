#include "experiments/real/truth_free/residual_pattern.h"

#include <algorithm>
#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "experiments/real/truth_free/twin.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

struct PlacedResidual {
  Eigen::Vector2d x1_px;
  double residual_px;  // over the match's noise_scale
};

// From left to right.
std::vector<PlacedResidual> ListResiduals(const MotionProblem& problem, const MotionEstimate& estimate) {
  const Eigen::Matrix3d F = ComputeFundamental(problem, estimate.cam2_from_cam1);
  std::vector<PlacedResidual> residuals;
  for (const int i : estimate.inliers) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const EpipolarConstraint c = EvaluateConstraint(F, match);
    const double scale = NoiseScaleAt(problem, static_cast<size_t>(i));
    residuals.push_back({match.x1_px, c.g / std::sqrt(c.squared_gradient()) / scale});
  }
  std::ranges::sort(residuals, {}, [](const PlacedResidual& r) { return r.x1_px.x(); });
  return residuals;
}

}  // namespace

ResidualProducts& ResidualProducts::operator+=(const ResidualProducts& other) {
  for (size_t k = 0; k < kNumDistances; ++k) {
    sums[k] += other.sums[k];
    counts[k] += other.counts[k];
  }
  return *this;
}

ResidualProducts SumProducts(const MotionProblem& problem, const MotionEstimate& estimate) {
  const std::vector<PlacedResidual> residuals = ListResiduals(problem, estimate);
  ResidualProducts products;
  double sum_squares = 0.0;
  for (const PlacedResidual& r : residuals) sum_squares += r.residual_px * r.residual_px;
  const double mean_square = sum_squares / static_cast<double>(residuals.size());
  for (size_t i = 0; i < residuals.size(); ++i) {
    for (size_t k = i + 1; k < residuals.size(); ++k) {
      if (residuals[k].x1_px.x() - residuals[i].x1_px.x() >= kDistanceEdgesPx.back()) break;
      const double distance = (residuals[k].x1_px - residuals[i].x1_px).norm();
      if (distance >= kDistanceEdgesPx.back()) continue;
      const auto above = std::ranges::upper_bound(kDistanceEdgesPx, distance);
      const auto bin = static_cast<size_t>(above - kDistanceEdgesPx.begin() - 1);
      products.sums[bin] += residuals[i].residual_px * residuals[k].residual_px / mean_square;
      products.counts[bin] += 1.0;
    }
  }
  return products;
}

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
