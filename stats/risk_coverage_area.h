// The area under the risk-coverage curve (thresholds.h): the share of failures averaged over all shares of
// answered trials, most confident first. It is 0 if nothing fails, and the failure rate if the score is
// uninformative.
#pragma once

#include <cstdint>
#include <span>

#include "stats/clustered_estimate.h"

namespace rcme {

struct ClusteredOutcome {
  double score = 0.0;  // confidence: the greatest is answered first
  bool failed = false;
  std::int64_t cluster = 0;
};

// Mean over k = 1..n of the share of failures among the k most confident (Geifman & El-Yaniv 2017), equal
// scores in random order: the ranked loss of ranked_loss.h with loss 1 for a failure. The standard error is
// clustered. The interval is Student's on the logarithm, with min(m, C - 1) degrees of freedom and a variance
// of (m + 2) / m times the estimated one, m the number of the C clusters with a failure, or of those with a
// success if these are fewer: the usual C - 1 degrees of freedom cover too little where few trials fail
// (tests/stats/risk_coverage_area_test.cc). Without a failure it is [0, q (1 -
// log q)], the greatest area at failure rate q, with q the upper end of the exact interval for no failures in
// as many trials as there are clusters; without a success [1 - q (1 - log q), 1], the least area at success
// rate q. Throws std::invalid_argument if there are no outcomes or a score is NaN.
ClusteredEstimate MeasureRiskCoverageArea(std::span<const ClusteredOutcome> outcomes,
                                          double confidence = 0.95);

}  // namespace rcme
