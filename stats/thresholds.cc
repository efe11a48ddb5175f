#include "stats/thresholds.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>

namespace rcme {
namespace {

void CheckScores(const std::vector<double>& scores) {
  if (scores.empty()) throw std::invalid_argument("ROC: a sample is empty");
  for (const double score : scores) {
    if (std::isnan(score)) throw std::invalid_argument("ROC: a score is NaN");
  }
}

// For each threshold the share of scores that are at least as large.
std::vector<double> SharesAtLeast(std::vector<double> scores, const std::vector<double>& thresholds) {
  std::sort(scores.begin(), scores.end());
  std::vector<double> shares;
  for (const double threshold : thresholds) {
    const auto num_below = std::lower_bound(scores.begin(), scores.end(), threshold) - scores.begin();
    shares.push_back(static_cast<double>(std::ssize(scores) - num_below) /
                     static_cast<double>(scores.size()));
  }
  return shares;
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
