#include "stats/risk_coverage_area.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/distributions.h"
#include "stats/ranked_loss.h"

namespace rcme {
namespace {

// Student's interval on the logarithm; no end is below 0.
Interval LogInterval(const ClusteredEstimate& area, double confidence) {
  if (area.num_clusters < 2) return {0.0, 1.0};
  if (area.value == 0.0) {
    const double rate = ExactBinomialInterval(0, area.num_clusters, confidence).upper;
    return {0.0, rate * (1.0 - std::log(rate))};
  }
  const double half = (area.interval.upper - area.value) / area.value;
  return {area.value * std::exp(-half), std::min(1.0, area.value * std::exp(half))};
}

}  // namespace

ClusteredEstimate MeasureRiskCoverageArea(std::span<const ClusteredOutcome> outcomes, double confidence) {
  std::vector<double> scores, losses;
  std::vector<std::int64_t> clusters;
  for (const ClusteredOutcome& outcome : outcomes) {
    scores.push_back(outcome.score);
    losses.push_back(outcome.failed ? 1.0 : 0.0);
    clusters.push_back(outcome.cluster);
  }
  const RankedLoss ranked = MeasureRankedLoss(scores, losses);
  ClusteredEstimate estimate = EstimateFromInfluences(ranked.area, ranked.influences, clusters, confidence);
  estimate.interval = LogInterval(estimate, confidence);
  return estimate;
}

}  // namespace rcme
