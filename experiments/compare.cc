#include "experiments/compare.h"

#include <fmt/format.h>

#include <limits>

#include "parameters/input_error.h"
#include "stats/multiple_testing.h"

namespace rcme {
namespace {

bool HasRefused(const TrialRecord& record, const FailureBounds&) {
  return record.status != MotionStatus::kOk;
}

// Not the same as no success: a motion whose truth is not known is neither.
bool HasFailedOrRefused(const TrialRecord& record, const FailureBounds& bounds) {
  return HasRefused(record, bounds) || HasFailed(record, bounds);
}

size_t IndexOf(const std::string& label, const Study& study) {
  if (label.empty()) return 0;
  std::vector<std::string> labels;
  for (const EstimatorSpec& spec : study.estimators) {
    if (spec.label == label) return labels.size();
    labels.push_back(spec.label);
  }
  throw InputError(fmt::format("--against: study '{}' has no estimator '{}'; allowed: {}", study.name, label,
                               fmt::join(labels, ", ")));
}

// Paired counts of every condition, estimator and event; of the reference with itself too, which no one
// reads.
class PairCounts {
 public:
  PairCounts(const StudyPlan& plan, size_t reference)
      : bounds_(plan.study.failure),
        reference_(reference),
        num_conditions_(plan.conditions.size()),
        num_estimators_(plan.study.estimators.size()),
        cells_(num_conditions_ * num_estimators_ * ComparedEvents().size()) {}

  // Takes the records in the order of the store: all estimators of a trial, then the next trial.
  void Add(const TrialRecord& record) {
    const size_t expected = trial_.size() % num_estimators_;
    const bool is_next = expected == 0 || IsSameTrial(record, trial_.front());
    if (record.condition >= num_conditions_ || record.estimator != expected || !is_next) {
      throw InputError(
          fmt::format("the result file is damaged at condition {}, trial {}: a trial is not whole",
                      record.condition, record.trial));
    }
    if (expected == 0) trial_.clear();
    trial_.push_back(record);
    if (trial_.size() == num_estimators_) Count();
  }
  bool EndsWithAWholeTrial() const { return trial_.size() % num_estimators_ == 0; }

  const PairedCounts& Of(size_t condition, size_t estimator, size_t event) const {
    return cells_[(condition * num_estimators_ + estimator) * ComparedEvents().size() + event];
  }
  std::int64_t num_trials() const { return num_trials_; }

 private:
  static bool IsSameTrial(const TrialRecord& a, const TrialRecord& b) {
    return a.condition == b.condition && a.trial == b.trial;
  }
  void Count() {
    ++num_trials_;
    for (size_t v = 0; v < ComparedEvents().size(); ++v) {
      const ComparedEvent& event = ComparedEvents()[v];
      const bool in_reference = event.has_happened(trial_[reference_], bounds_);
      for (const TrialRecord& record : trial_) {
        const size_t row = record.condition * num_estimators_ + record.estimator;
        cells_[row * ComparedEvents().size() + v].Add(event.has_happened(record, bounds_), in_reference);
      }
    }
  }

  FailureBounds bounds_;
  size_t reference_, num_conditions_, num_estimators_;
  std::vector<PairedCounts> cells_;
  std::vector<TrialRecord> trial_;  // the records of the present trial so far
  std::int64_t num_trials_ = 0;
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

// A comparison without trials is no test: it costs the others nothing.
void AdjustForAllTestsOf(const std::string& event, std::vector<ComparisonRow>* rows) {
  std::vector<ComparisonRow*> tested;
  std::vector<double> p_values;
  for (ComparisonRow& row : *rows) {
    if (row.event != event || row.counts.n() == 0) continue;
    tested.push_back(&row);
    p_values.push_back(row.p_value);
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  for (size_t i = 0; i < tested.size(); ++i) tested[i]->holm_p_value = adjusted[i];
}

}  // namespace

const std::vector<ComparedEvent>& ComparedEvents() {
  static const std::vector<ComparedEvent> events = {
      {"failure", "a motion beyond a failure bound", HasFailed},
      {"refusal", "no motion, for whatever reason", HasRefused},
      {"failure_or_refusal", "one of the two", HasFailedOrRefused}};
  return events;
}

Comparison Compare(const ResultStore& store, const std::string& reference) {
  const StudyPlan plan = store.Plan();
  const std::vector<EstimatorSpec>& estimators = plan.study.estimators;
  const size_t reference_index = IndexOf(reference, plan.study);
  PairCounts pairs(plan, reference_index);
  store.ForEachRecord([&](const TrialRecord& record) { pairs.Add(record); });
  if (!pairs.EndsWithAWholeTrial()) {
    throw InputError("the result file is damaged: its last trial is not whole");
  }
  Comparison comparison{plan.study.name,    estimators[reference_index].label,
                        plan.factor_names,  {},
                        pairs.num_trials(), plan.NumTrials()};
  for (const Condition& condition : plan.conditions) {
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (e == reference_index) continue;
      for (size_t v = 0; v < ComparedEvents().size(); ++v) {
        ComparisonRow row = RowOf(pairs.Of(condition.index, e, v));
        row.condition = condition.index;
        row.levels = condition.levels;
        row.estimator = estimators[e].label;
        row.event = ComparedEvents()[v].name;
        comparison.rows.push_back(std::move(row));
      }
    }
  }
  for (const ComparedEvent& event : ComparedEvents()) AdjustForAllTestsOf(event.name, &comparison.rows);
  return comparison;
}

}  // namespace rcme
