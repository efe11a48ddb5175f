#include "experiments/truth_free/residual_pattern.h"

#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "experiments/truth_free/twin.h"
#include "stats/median_ratio.h"
#include "stats/order_statistic.h"

namespace rcme {

void PatternSum::Add(const MotionProblem& problem, const MotionEstimate& estimate) {
  if (estimate.status != MotionStatus::kOk) return;
  const double sigma_px = NoiseOf(problem, estimate);
  const Eigen::Matrix3d F = FundamentalOf(problem, estimate.cam2_from_cam1);
  sigmas_.push_back(sigma_px);
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    sizes_.push_back(std::sqrt(SquaredSampsonDistance(F, problem.matches[i])) /
                     (sigma_px * NoiseScaleAt(problem, i)));
  }
  products_ += ProductsOf(problem, estimate);
}

ResidualPattern PatternSum::Take() const {
  std::vector<double> sizes = sizes_;
  const double far = QuantileOf(sizes, 0.95);
  return {MedianOf(sigmas_), far / QuantileOf(sizes, 0.5), products_};
}

}  // namespace rcme
