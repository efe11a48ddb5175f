// How alike the residuals of neighbouring matches are.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// Distances in image 1 at which residuals are compared, px: [0, 1), [1, 4), [4, 16), [16, 64).
inline constexpr std::array<double, 5> kDistanceEdgesPx = {0.0, 1.0, 4.0, 16.0, 64.0};
inline constexpr size_t kNumDistances = kDistanceEdgesPx.size() - 1;

// Of the inliers of one pair: sums over pairs of matches at each distance of the product of their residuals
// r = g / |J|, which have the same sign on the same side of their epipolar lines, over the mean of r^2.
struct ResidualProducts {
  std::array<double, kNumDistances> sums{};
  std::array<double, kNumDistances> counts{};

  ResidualProducts& operator+=(const ResidualProducts& other);
  // Mean product: the correlation; NaN without any.
  double Correlation(size_t distance) const { return sums[distance] / counts[distance]; }
};
ResidualProducts SumProducts(const MotionProblem& problem, const MotionEstimate& estimate);

}  // namespace rcme
