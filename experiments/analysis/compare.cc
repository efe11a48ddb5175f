#include "experiments/analysis/compare.h"

#include <fmt/format.h>

#include <limits>

#include "parameters/input_error.h"
#include "stats/multiple_testing.h"

namespace rcme {
namespace {

size_t IndexOf(const std::string& label, const RunDescription& run) {
  if (label.empty()) return 0;
  std::vector<std::string> labels;
  for (const DescribedEstimator& estimator : run.estimators) {
    if (estimator.label == label) return labels.size();
    labels.push_back(estimator.label);
  }
  throw InputError(fmt::format("--against: study '{}' has no estimator '{}'; allowed: {}", run.study, label,
                               fmt::join(labels, ", ")));
}

// Paired counts of every condition, estimator and event; of the reference with itself too, which no one
// reads.
class PairCounts {
 public:
  PairCounts(const RunDescription& run, size_t reference)
      : bounds_(run.failure),
        reference_(reference),
        num_conditions_(run.conditions.size()),
        num_estimators_(run.estimators.size()),
        cells_(num_conditions_ * num_estimators_ * TrialEvents().size()) {}

  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    ++num_trials_;
    is_weighted_ = is_weighted_ || problem.weight != 1.0;
    for (size_t v = 0; v < TrialEvents().size(); ++v) {
      const TrialEvent& event = TrialEvents()[v];
      const bool in_reference = event.has_happened(records[reference_], bounds_);
      for (size_t e = 0; e < num_estimators_; ++e) {
        if (event.needs_truth && !(IsScored(records[e]) && IsScored(records[reference_]))) continue;
        cells_[IndexOfCell(problem.condition, e, v)].Add(event.has_happened(records[e], bounds_),
                                                         in_reference);
      }
    }
  }

  const PairedCounts& Of(size_t condition, size_t estimator, size_t event) const {
    return cells_[IndexOfCell(condition, estimator, event)];
  }
  std::int64_t num_trials() const { return num_trials_; }
  bool is_weighted() const { return is_weighted_; }

 private:
  size_t IndexOfCell(size_t condition, size_t estimator, size_t event) const {
    return (condition * num_estimators_ + estimator) * TrialEvents().size() + event;
  }

  FailureBounds bounds_;
  size_t reference_, num_conditions_, num_estimators_;
  std::vector<PairedCounts> cells_;
  std::int64_t num_trials_ = 0;
  bool is_weighted_ = false;
};

ComparisonRow RowOf(const PairedCounts& counts) {
  ComparisonRow row;
  row.counts = counts;
  row.interval = RiskDifferenceInterval(counts);
  const bool has_trials = counts.n() > 0;
  row.risk_difference = has_trials ? counts.RiskDifference() : std::numeric_limits<double>::quiet_NaN();
  row.p_value = has_trials ? McNemarExactPValue(counts) : std::numeric_limits<double>::quiet_NaN();
  row.holm_p_value = row.p_value;
  return row;
}

// One family: whoever reads the tables reads all of them, and Holm's procedure holds however the tests depend
// on each other (an event and its union with another do). A comparison without trials is no test: it costs
// the others nothing.
void AdjustForAllTests(std::vector<ComparisonRow>* rows) {
  std::vector<ComparisonRow*> tested;
  std::vector<double> p_values;
  for (ComparisonRow& row : *rows) {
    if (row.counts.n() == 0) continue;
    tested.push_back(&row);
    p_values.push_back(row.p_value);
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  for (size_t i = 0; i < tested.size(); ++i) tested[i]->holm_p_value = adjusted[i];
}

}  // namespace

Comparison Compare(const ResultStore& store, const std::string& reference) {
  const RunDescription run = store.Description();
  const std::vector<DescribedEstimator>& estimators = run.estimators;
  const size_t reference_index = IndexOf(reference, run);
  PairCounts pairs(run, reference_index);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    pairs.Add(problem, records);
  });
  Comparison comparison{
      run.study, estimators[reference_index].label, run.factors, {}, pairs.num_trials(), run.NumTrials(), {}};
  if (pairs.is_weighted()) {
    comparison.caution =
        "trials are weighted (tilted_to): counts of them say nothing, so there are none here";
    return comparison;
  }
  if (!run.stopping_rule.empty()) {
    comparison.caution =
        "the number of trials depended on their outcomes (--until): p-values and intervals here hold for a "
        "number "
        "fixed beforehand only";
  }
  for (std::uint32_t c = 0; c < run.conditions.size(); ++c) {
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (e == reference_index) continue;
      for (size_t v = 0; v < TrialEvents().size(); ++v) {
        ComparisonRow row = RowOf(pairs.Of(c, e, v));
        row.condition = c;
        row.levels = run.conditions[c].levels;
        row.estimator = estimators[e].label;
        row.event = TrialEvents()[v].name;
        comparison.rows.push_back(std::move(row));
      }
    }
  }
  AdjustForAllTests(&comparison.rows);
  return comparison;
}

}  // namespace rcme
