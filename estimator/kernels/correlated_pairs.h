// Sums over all pairs of points whose errors are correlated, many pairs at a time: what
// robust_covariance/residual_variances.h needs of n (n - 1) / 2 of them.
#pragma once

#include <numbers>
#include <vector>

#include "estimator/kernels/match_blocks.h"

namespace rcme {

inline constexpr int kNumCorrelationLengths = 3;  // 1, 1/3 and 1/9 of the longest, the shortest first

// In these units of the longest length l, exp(-d / l) = 2^(-d / 8).
inline constexpr double kDistanceUnit = std::numbers::ln2 / 8.0;

// Eight points, each with a residual and a row of five numbers. All zero beyond the last point.
struct alignas(64) CorrelatedBlock {
  double at[4][kBlockSize] = {};      // x1, y1, x2, y2 in units of kDistanceUnit l
  double normal[4][kBlockSize] = {};  // u, of length 1: its halves belong to the two images
  double residual[kBlockSize] = {};
  double weight[kBlockSize] = {};     // 1 / m, m the number of the point's matches
  double row[5][kBlockSize] = {};     // a sum over these
  double excess[5][kBlockSize] = {};  // of their mean over the sum: (1 / m - 1) row
};

// For each of eight points g: sums over h /= g of c_gh(l_k) times row h, and times the mean row / m.
struct alignas(64) SmoothedBlock {
  double row[kNumCorrelationLengths][5][kBlockSize] = {};
  double mean[kNumCorrelationLengths][5][kBlockSize] = {};
};

// With c_gh(l) = u_g1' u_h1 exp(-d_gh1 / l) + u_g2' u_h2 exp(-d_gh2 / l), each pair g, h once.
struct CorrelatedPairSums {
  double squares[6] = {};                        // of c(l_k) c(l_m), m <= k: a lower triangle row by row
  double weighted[6] = {};                       // the same times both weights
  double products[kNumCorrelationLengths] = {};  // of c(l_k) times both residuals
  std::vector<SmoothedBlock> smoothed;
};
// The first `num_repeated` points are those of several matches: only their pairs take the time of a second
// pass.
CorrelatedPairSums SumCorrelatedPairs(const std::vector<CorrelatedBlock>& points, size_t num_repeated);

}  // namespace rcme
