// The area under the risk-coverage curve (thresholds.h): the mean share of failures over all shares of trials
// answered, the surest first. 0: nothing fails; the rate of failures: the score knows nothing.
#pragma once

#include <cstdint>
#include <span>

#include "stats/clustered_estimate.h"

namespace rcme {

struct ClusteredOutcome {
  double score = 0.0;  // of confidence: the greatest is answered first
  bool failed = false;
  std::int64_t cluster = 0;
};

// Mean over k = 1..n of the share that failed among the k surest (Geifman & El-Yaniv 2017), equal scores in
// random order: the ranked loss of ranked_loss.h, a failure a loss of 1. The standard error is by clusters.
// The interval is Student's on the logarithm; without a failure, [0, q (1 - log q)], the greatest area that a
// rate q has, with q the upper end of the exact interval of the rate of no failures in as many trials as
// there are clusters. Throws std::invalid_argument if there are no outcomes or a score is NaN.
ClusteredEstimate MeasureRiskCoverageArea(std::span<const ClusteredOutcome> outcomes,
                                          double confidence = 0.95);

}  // namespace rcme
