// What the summary needs of the trials of one condition, in memory that does not grow with them and in sums
// without rounding errors, so that neither the order of the trials nor how they are grouped changes a bit.
//
// Exact: rates with their intervals, medians with theirs (as they are of trials), means and standard errors
// (correctly rounded), scores; the bounds of a score's mean are of scores moved by at most 1e-10
// (stats/exact_scores.h).
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "experiments/run/store/counts_tables.h"
#include "stats/exact_moments.h"
#include "stats/exact_scores.h"
#include "stats/stream_median.h"

namespace rcme {

struct RateCount {
  std::int64_t n = 0, num_events = 0;
};
using QuantityCounts = std::variant<RateCount, ExactMoments, StreamMedian, ExactScores>;  // by kind

class SummaryCell {
 public:
  explicit SummaryCell(size_t num_estimators);

  // A trial without a weight.
  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records,
           const FailureBounds& bounds);
  void Merge(const SummaryCell& other);

  std::int64_t num_trials() const { return num_trials_; }
  // The rows of a summary; `cell` holds what they share but for the estimator.
  void AppendRows(const RunDescription& run, SummaryRow cell, std::vector<SummaryRow>* rows) const;

  std::vector<CountedQuantity> Texts() const;
  // Throws Damage for texts that it does not give, or not of so many trials.
  static SummaryCell FromTexts(const std::vector<CountedQuantity>& texts, size_t num_estimators,
                               std::int64_t num_trials);

 private:
  std::int64_t num_trials_ = 0;
  std::vector<std::vector<QuantityCounts>> estimators_;  // by estimator and TrialQuantities()
  std::vector<QuantityCounts> problems_;                 // by ProblemQuantities()
};

}  // namespace rcme
