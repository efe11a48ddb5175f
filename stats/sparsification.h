// How well stated uncertainties rank errors: the area under the sparsification error (AUSE, Ilg et al. 2018).
//
// The most uncertain answers are removed one by one; the mean error of the remaining ones is the
// sparsification curve. The oracle removes the greatest errors. The AUSE is the area between the two curves
// over all shares, divided by the mean error: 0 for the oracle's order. A random order has the mean error at
// every share. Its AUSE, 1 minus the oracle's area over the mean error, is that of an uninformative ranking;
// a greater one is worse than random.
#pragma once

#include <cstdint>
#include <span>

#include "stats/clustered_estimate.h"

namespace rcme {

struct StatedError {
  double stated = 0.0, error = 0.0;  // stated uncertainty and actual error; not negative
  std::int64_t cluster = 0;          // errors of different clusters are independent
};

struct Sparsification {
  ClusteredEstimate ause;         // NaN if no error is above 0
  ClusteredEstimate ause_random;  // of a random order of the same errors
};

// Curves over the shares k / n, k = 1..n, equal uncertainties in random order. With the areas A_s (by
// uncertainty) and A_o (by error) and the mean m of ranked_loss.h, an error changes D = (A_s - A_o) / m by
//   (dA_s - dA_o - D dm) / m.
// The standard error is that of the cluster sums of these influences, to first order that of a bootstrap over
// clusters. The 95 % intervals are Student's, with no end below 0. Throws std::invalid_argument without
// errors, and for one that is negative or not finite.
Sparsification MeasureSparsification(std::span<const StatedError> errors);

}  // namespace rcme
