#include "stats/risk_coverage_area.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "stats/distributions.h"
#include "stats/ranked_loss.h"

namespace rcme {
namespace {

// The number of clusters with a failure, or of those with a success if these are fewer.
std::int64_t CountRarer(std::span<const ClusteredOutcome> outcomes) {
  std::set<std::int64_t> with_failure, with_success;
  for (const ClusteredOutcome& outcome : outcomes)
    (outcome.failed ? with_failure : with_success).insert(outcome.cluster);
  return std::min(std::ssize(with_failure), std::ssize(with_success));
}

// Student's interval on the logarithm; no end is below 0.
Interval LogInterval(const ClusteredEstimate& area, std::int64_t num_rarer, double confidence) {
  if (area.num_clusters < 2) return {0.0, 1.0};
  if (num_rarer == 0) {
    const double rate = ExactBinomialInterval(0, area.num_clusters, confidence).upper,
                 greatest = rate * (1.0 - std::log(rate));
    return area.value == 0.0 ? Interval{0.0, greatest} : Interval{1.0 - greatest, 1.0};
  }
  const double m = static_cast<double>(num_rarer),
               dof = std::min(m, static_cast<double>(area.num_clusters - 1));
  const double half = StudentQuantile(dof, 0.5 * (1.0 + confidence)) * area.standard_error *
                      std::sqrt((m + 2.0) / m) / area.value;
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
  estimate.interval = LogInterval(estimate, CountRarer(outcomes), confidence);
  return estimate;
}

}  // namespace rcme
