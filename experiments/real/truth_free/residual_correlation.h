// Correlation of the residuals of neighbouring matches.
#pragma once

#include <array>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Distances in image 1 at which residuals are compared, px: [0, 1), [1, 4), [4, 16), [16, 64).
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

}  // namespace rcme
