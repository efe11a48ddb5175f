// What a ranking is worth: the mean loss of the first k of n, averaged over k.
#pragma once

#include <span>
#include <vector>

namespace rcme {

struct RankedLoss {
  double area = 0.0, mean = 0.0;  // of the ranking; of all losses, which is the area of a random order
  std::vector<double> influences, mean_influences;  // how far each loss moves either
};

// Losses in the order of their scores, the greatest first (1), equal scores in random order: with the
// harmonic numbers H the area under the curve of mean losses is
//   A = 1/n sum_k 1/k sum_(rank_i <= k) y_i = sum_i y_i (H_n - H_(rank_i - 1)) / n.
// Its limit is A = E[y (-log u)], u = G(score) the rank as a share. Moving the share eps of the law to loss j
// makes G (1 - eps) G + eps [u_j <= u], so that dA = y_j (-log u_j) - A - E[y ([u_j <= u] - u) / u] eps: the
// loss moves the area by
//   (y_j (-log u_j) - int_(u_j)^1 r(u) / u du - A + E[y]) / n,  r(u) the mean loss at rank u.
// Throws std::invalid_argument without losses, for a score that is NaN, a loss that is not finite, and unless
// there are as many of both.
RankedLoss MeasureRankedLoss(std::span<const double> scores, std::span<const double> losses);

}  // namespace rcme
