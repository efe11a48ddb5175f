// How well stated uncertainties rank errors: the area under the sparsification error (AUSE, Ilg et al. 2018).
//
// The most uncertain answers are taken away one by one; the mean error of those left is the sparsification
// curve. The oracle takes away the greatest errors. The area between the two curves over all shares, divided
// by the mean error, is the AUSE: 0 for the oracle's order. A random order has the mean error at every share,
// so that its AUSE, 1 less the oracle's area over the mean error, is what a ranking without knowledge has; a
// greater one is worse than none.
#pragma once

#include <cstdint>
#include <span>

#include "stats/clustered_estimate.h"

namespace rcme {

struct StatedError {
  double stated = 0.0, error = 0.0;  // the uncertainty that is stated, and the error; not negative
  std::int64_t cluster = 0;          // errors of different clusters are independent
};

struct Sparsification {
  ClusteredEstimate ause;         // NaN where no error is above 0
  ClusteredEstimate ause_random;  // of a random order of the same errors
};

// Curves over the shares k / n, k = 1..n, equal uncertainties in random order. With the areas A_s (by the
// uncertainty), A_o (by the error) and the mean m of ranked_loss.h, an error moves D = (A_s - A_o) / m by
//   (dA_s - dA_o - D dm) / m,
// and the standard error is of the sums of these by clusters, to first order that of a bootstrap which draws
// whole clusters. Intervals are Student's, no end below 0. Throws std::invalid_argument without errors, and
// for one that is negative or not finite.
Sparsification MeasureSparsification(std::span<const StatedError> errors, double confidence = 0.95);

}  // namespace rcme
