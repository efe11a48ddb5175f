// The value of a ranking: the mean loss of the first k of n, averaged over k.
#pragma once

#include <span>
#include <vector>

namespace rcme {

struct RankedLoss {
  double area = 0.0, mean = 0.0;  // of the ranking; of all losses, the expected area of a random order
  std::vector<double> influences, mean_influences;  // influence of each loss on either
};

// Losses are ordered by score, the greatest first (rank 1), equal scores in random order. With the harmonic
// numbers H the area under the curve of mean losses is
//   A = 1/n sum_k 1/k sum_(rank_i <= k) y_i = sum_i y_i (H_n - H_(rank_i - 1)) / n.
// Its limit is A = E[y (-log u)], u = G(score) the rank as a share. Moving a share eps of the law to loss j
// changes G to (1 - eps) G + eps [u_j <= u], so dA = (y_j (-log u_j) - A - E[y ([u_j <= u] - u) / u]) eps.
// The loss therefore moves the area by
//   (y_j (-log u_j) - int_(u_j)^1 r(u) / u du - A + E[y]) / n,  r(u) the mean loss at rank u.
// Throws std::invalid_argument without losses, for a score that is NaN, a loss that is not finite, or lists
// of different length.
RankedLoss MeasureRankedLoss(std::span<const double> scores, std::span<const double> losses);

}  // namespace rcme
