#include "stats/thresholds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

void CheckScores(const std::vector<double>& scores) {
  if (scores.empty()) throw std::invalid_argument("ROC: a sample is empty");
  for (const double score : scores) {
    if (std::isnan(score)) throw std::invalid_argument("ROC: a score is NaN");
  }
}

// The share of `sorted` that is below x, equal ones counting half.
double ShareBelow(const std::vector<double>& sorted, double x) {
  const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), x);
  return 0.5 * static_cast<double>((low - sorted.begin()) + (high - sorted.begin())) /
         static_cast<double>(sorted.size());
}

// For each threshold the share of the scores that are not below it.
std::vector<double> SharesAtLeast(std::vector<double> scores, const std::vector<double>& thresholds) {
  std::sort(scores.begin(), scores.end());
  std::vector<double> shares;
  for (const double threshold : thresholds) {
    const auto num_below = std::lower_bound(scores.begin(), scores.end(), threshold) - scores.begin();
    shares.push_back(1.0 - static_cast<double>(num_below) / static_cast<double>(scores.size()));
  }
  return shares;
}

// Moments of each score's ShareBelow the other sample: DeLong's structural components.
Moments PlacementsOf(const std::vector<double>& scores, const std::vector<double>& sorted_others) {
  Moments placements;
  for (const double score : scores) placements.Add(ShareBelow(sorted_others, score));
  return placements;
}

}  // namespace

std::vector<RocPoint> RocCurve(const std::vector<double>& negatives, const std::vector<double>& positives) {
  CheckScores(negatives);
  CheckScores(positives);
  std::vector<double> thresholds = negatives;
  thresholds.insert(thresholds.end(), positives.begin(), positives.end());
  std::sort(thresholds.begin(), thresholds.end(), std::greater<>());
  thresholds.erase(std::unique(thresholds.begin(), thresholds.end()), thresholds.end());
  const std::vector<double> from_negatives = SharesAtLeast(negatives, thresholds);
  const std::vector<double> from_positives = SharesAtLeast(positives, thresholds);
  std::vector<RocPoint> curve = {{std::numeric_limits<double>::infinity(), 0.0, 0.0}};
  for (size_t i = 0; i < thresholds.size(); ++i) {
    curve.push_back({thresholds[i], from_negatives[i], from_positives[i]});
  }
  return curve;
}

AreaUnderCurve MeasureAreaUnderCurve(const std::vector<double>& negatives,
                                     const std::vector<double>& positives, double confidence) {
  CheckScores(negatives);
  CheckScores(positives);
  std::vector<double> sorted_negatives = negatives, sorted_positives = positives;
  std::sort(sorted_negatives.begin(), sorted_negatives.end());
  std::sort(sorted_positives.begin(), sorted_positives.end());
  const Moments of_positives = PlacementsOf(positives, sorted_negatives);
  const Moments of_negatives = PlacementsOf(negatives, sorted_positives);

  AreaUnderCurve area;
  area.value = of_positives.mean();
  area.standard_error = std::hypot(of_positives.standard_error(), of_negatives.standard_error());
  const double half = NormalQuantile(0.5 * (1.0 + confidence)) * area.standard_error;
  area.interval = {std::max(0.0, area.value - half), std::min(1.0, area.value + half)};
  const double num_pairs = static_cast<double>(std::min(negatives.size(), positives.size()));
  const double perfect_end = std::pow(0.5 * (1.0 - confidence), 1.0 / num_pairs);
  if (area.value == 1.0) area.interval = {perfect_end, 1.0};
  if (area.value == 0.0) area.interval = {0.0, 1.0 - perfect_end};
  return area;
}

std::vector<RiskCoveragePoint> RiskCoverageCurve(std::vector<ScoredOutcome> outcomes) {
  for (const ScoredOutcome& outcome : outcomes) {
    if (std::isnan(outcome.score)) throw std::invalid_argument("risk-coverage: a score is NaN");
  }
  std::sort(outcomes.begin(), outcomes.end(),
            [](const ScoredOutcome& a, const ScoredOutcome& b) { return a.score > b.score; });
  std::vector<RiskCoveragePoint> curve;
  size_t num_failed = 0;
  for (size_t i = 0; i < outcomes.size(); ++i) {
    num_failed += outcomes[i].failed ? 1 : 0;
    if (i + 1 < outcomes.size() && outcomes[i + 1].score == outcomes[i].score) continue;
    const double answered = static_cast<double>(i + 1);
    curve.push_back({outcomes[i].score, answered / static_cast<double>(outcomes.size()),
                     static_cast<double>(num_failed) / answered});
  }
  return curve;
}

}  // namespace rcme
