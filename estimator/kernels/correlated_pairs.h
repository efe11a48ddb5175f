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

// Eight points, each with a residual and five numbers of its own. All zero beyond the last point.
struct alignas(64) CorrelatedBlock {
  double at[4][kBlockSize] = {};      // x1, y1, x2, y2 in units of kDistanceUnit l
  double normal[4][kBlockSize] = {};  // u, of length 1: its halves belong to the two images
  double residual[kBlockSize] = {};
  double weight[kBlockSize] = {};   // 1 / m, m the point's number of matches
  double row[5][kBlockSize] = {};   // sums over the matches
  double mean[5][kBlockSize] = {};  // row / m
};

// For each of eight points g: sums over h /= g of c_gh(l_k) times row h, and times mean h.
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
// Where no point has two matches (`are_repeated` false), weights are 1 and means are rows: `weighted` and
// `mean` are then those of `squares` and `row`, at no cost.
CorrelatedPairSums SumCorrelatedPairs(const std::vector<CorrelatedBlock>& points, bool are_repeated);

}  // namespace rcme
