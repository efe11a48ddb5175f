// Size, tails and correlation of the residuals of several pairs.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Distances in image 1 at which the residuals of neighbouring matches are compared, px: [0, 1), [1, 4), [4,
// 16), [16, 64).
inline constexpr std::array<double, 5> kDistanceEdgesPx = {0.0, 1.0, 4.0, 16.0, 64.0};
inline constexpr size_t kNumDistances = kDistanceEdgesPx.size() - 1;

// Sums over the pairs of inliers at each distance, for one image pair: the product of their residuals over
// the mean of r^2. Residuals are r = g / |J| over the match's noise_scale; they have the same sign on the
// same side of the epipolar lines.
struct ResidualProducts {
  std::array<double, kNumDistances> sums{};
  std::array<double, kNumDistances> counts{};

  ResidualProducts& operator+=(const ResidualProducts& other);
  // Mean product; NaN without any.
  double Correlation(size_t distance) const { return sums[distance] / counts[distance]; }
};
ResidualProducts SumProducts(const MotionProblem& problem, const MotionEstimate& estimate);

struct ResidualPattern {
  double sigma_px = 0.0;    // geometric mean of the estimated noise; NaN if no pair has a motion
  double tail_ratio = 0.0;  // 95 % point over the median of |r| / sigma, all pairs together
  ResidualProducts products;
};

// Sampson distances of the inliers, divided by the noise (EstimateNoise) and by each match's noise scale.
std::vector<double> ResidualSizes(const MotionProblem& problem, const MotionEstimate& estimate);

// Accumulates the pattern over pairs; refusals are skipped.
class PatternSum {
 public:
  void Add(const MotionProblem& problem, const MotionEstimate& estimate);
  ResidualPattern Take() const;

 private:
  double sum_log_sigma_ = 0.0, num_answers_ = 0.0;
  std::vector<double> sizes_;
  ResidualProducts products_;
};

}  // namespace rcme
