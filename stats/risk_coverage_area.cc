#include "stats/risk_coverage_area.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/distributions.h"

namespace rcme {
namespace {

// The places of the outcomes, surest first.
std::vector<size_t> SurestFirst(std::span<const ClusteredOutcome> outcomes) {
  if (outcomes.empty()) throw std::invalid_argument("risk-coverage: no outcomes");
  for (const ClusteredOutcome& outcome : outcomes) {
    if (std::isnan(outcome.score)) throw std::invalid_argument("risk-coverage: a score is NaN");
  }
  std::vector<size_t> order(outcomes.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return outcomes[a].score > outcomes[b].score; });
  return order;
}

// Equal scores, ranks first + 1 to last.
struct Tie {
  size_t first = 0, last = 0;
  double num_failed = 0.0;
  double weight = 0.0;  // mean of H_n - H_(rank - 1) over the ranks
};

std::vector<Tie> FindTies(std::span<const ClusteredOutcome> outcomes, const std::vector<size_t>& order) {
  std::vector<Tie> ties;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || outcomes[order[i]].score != outcomes[order[i - 1]].score) ties.push_back({i, i});
    ties.back().last = i + 1;
    ties.back().num_failed += outcomes[order[i]].failed ? 1.0 : 0.0;
  }
  double from_here = 0.0;  // 1 / rank + ... + 1 / n
  for (auto tie = ties.rbegin(); tie != ties.rend(); ++tie) {
    for (size_t rank = tie->last; rank > tie->first; --rank) {
      from_here += 1.0 / static_cast<double>(rank);
      tie->weight += from_here / static_cast<double>(tie->last - tie->first);
    }
  }
  return ties;
}

// On the logarithm; no end is below 0.
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
  const std::vector<size_t> order = SurestFirst(outcomes);
  const std::vector<Tie> ties = FindTies(outcomes, order);
  const double n = static_cast<double>(outcomes.size());
  double area = 0.0, rate = 0.0;
  for (const Tie& tie : ties) area += tie.num_failed * tie.weight / n, rate += tie.num_failed / n;
  std::vector<double> influences(outcomes.size());
  double later = 0.0;  // the integral of r(u) / u from the end of the tie to 1
  for (auto tie = ties.rbegin(); tie != ties.rend(); ++tie) {
    const double count = static_cast<double>(tie->last - tie->first), risk = tie->num_failed / count;
    // Within the tie r is constant, and a trial's own place in it any: the mean over the places of the sum of
    // 1 / rank from the place on.
    double inner = 0.0, mean_inner = 0.0;
    for (size_t rank = tie->last; rank > tie->first; --rank) {
      inner += risk / static_cast<double>(rank);
      mean_inner += inner / count;
    }
    for (size_t i = tie->first; i < tie->last; ++i) {
      const double own = outcomes[order[i]].failed ? tie->weight : 0.0;
      influences[order[i]] = (own - later - mean_inner - area + rate) / n;
    }
    later += inner;
  }
  std::vector<std::int64_t> clusters;
  for (const ClusteredOutcome& outcome : outcomes) clusters.push_back(outcome.cluster);
  ClusteredEstimate estimate = EstimateFromInfluences(area, influences, clusters, confidence);
  estimate.interval = LogInterval(estimate, confidence);
  return estimate;
}

}  // namespace rcme
