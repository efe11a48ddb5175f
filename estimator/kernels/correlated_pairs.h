// Sums over all n (n - 1) / 2 pairs of points with correlated errors, many pairs at a time, for
// robust_covariance/residual_variances.h.
#pragma once

#include <numbers>
#include <vector>

#include "estimator/kernels/match_blocks.h"

namespace rcme {

inline constexpr int kNumCorrelationLengths = 3;  // l / 9, l / 3 and l, l the longest

// In this unit of the longest length l, exp(-d / l) = 2^(-d / 8).
inline constexpr double kDistanceUnit = std::numbers::ln2 / 8.0;

// Eight points, each with a residual and a row of five numbers. Places beyond the last point hold zeros.
struct alignas(64) CorrelatedBlock {
  double at[4][kBlockSize] = {};      // x1, y1, x2, y2 in units of kDistanceUnit l
  double normal[4][kBlockSize] = {};  // unit vector u; two components per image
  double residual[kBlockSize] = {};
  double weight[kBlockSize] = {};     // 1 / m, m the number of the point's matches
  double row[5][kBlockSize] = {};     // sum over the point's matches
  double excess[5][kBlockSize] = {};  // their mean minus their sum: (1 / m - 1) row
};

// For each of eight points g: sums over h != g of c_gh(l_k) times row h, and times the mean, row h / m_h.
struct alignas(64) SmoothedBlock {
  double row[kNumCorrelationLengths][5][kBlockSize] = {};
  double mean[kNumCorrelationLengths][5][kBlockSize] = {};
};

// Sums over pairs, each pair g, h once, with c_gh(l) = u_g1' u_h1 exp(-d_gh1 / l) + u_g2' u_h2
// exp(-d_gh2 / l).
struct CorrelatedPairSums {
  double squares[6] = {};                        // of c(l_k) c(l_m), m <= k: a lower triangle, row by row
  double weighted[6] = {};                       // the same times both weights
  double products[kNumCorrelationLengths] = {};  // of c(l_k) times both residuals
  std::vector<SmoothedBlock> smoothed;
};
// The first `num_repeated` points are those with several matches. Only their pairs need a second pass.
CorrelatedPairSums SumCorrelatedPairs(const std::vector<CorrelatedBlock>& points, size_t num_repeated);

}  // namespace rcme
