#include "experiments/analysis/compare.h"

#include <fmt/format.h>

#include <limits>

#include "parameters/input_error.h"
#include "stats/multiple_testing.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

// The pairs of one condition, estimator and thing compared, growing trial by trial.
class Pairs {
 public:
  explicit Pairs(ComparedKind kind) : kind_(kind) {}

  void Add(double first, double second) {
    if (kind_ == ComparedKind::kEvent) {
      counts_.Add(first != 0.0, second != 0.0);
    } else if (kind_ == ComparedKind::kScore) {
      score_difference_.Add(first - second);
    } else {
      counts_.Add(first > second, second > first);
      error_difference_.Add(first == second ? 0.0 : first - second);  // two infinite errors are equal
    }
  }

  // What a row says of them.
  void Fill(bool is_anytime_valid, ComparisonRow* row) const {
    row->kind = kind_;
    row->is_anytime_valid = is_anytime_valid || kind_ == ComparedKind::kScore;
    row->counts = counts_;
    if (kind_ == ComparedKind::kEvent) FillEvent(row);
    if (kind_ == ComparedKind::kScore) FillScore(row);
    if (kind_ == ComparedKind::kError) FillError(row);
    if (row->n == 0) row->p_value = kNaN;
    row->holm_p_value = row->p_value;
  }

 private:
  double PValueOfCounts(bool is_anytime_valid) const {
    return is_anytime_valid ? AnytimeMcNemarPValue(counts_) : McNemarExactPValue(counts_);
  }

  void FillEvent(ComparisonRow* row) const {
    row->n = counts_.n();
    row->difference = row->n > 0 ? counts_.RiskDifference() : kNaN;
    row->p_value = PValueOfCounts(row->is_anytime_valid);
    row->interval = row->is_anytime_valid ? AnytimeRiskDifferenceInterval() : RiskDifferenceInterval(counts_);
  }
  void FillScore(ComparisonRow* row) const {
    row->n = score_difference_.n();
    row->difference = score_difference_.mean();
    row->p_value = score_difference_.PValue(0.0);
    row->interval = score_difference_.Sequence();
  }
  // The sign test: McNemar's of "greater than the other". Its median's interval is of a fixed number of
  // trials.
  void FillError(ComparisonRow* row) const {
    row->n = error_difference_.n();
    row->difference = error_difference_.median();
    row->p_value = PValueOfCounts(row->is_anytime_valid);
    row->interval =
        row->is_anytime_valid || row->n == 0 ? Interval{kNaN, kNaN} : error_difference_.interval();
  }

  Interval AnytimeRiskDifferenceInterval() const {
    ScoreMean difference({-1.0, 1.0});
    difference.Add(1.0, counts_.first_only);
    difference.Add(-1.0, counts_.second_only);
    difference.Add(0.0, counts_.both + counts_.neither);
    return difference.Sequence();
  }

  ComparedKind kind_;
  PairedCounts counts_;
  ScoreMean score_difference_{{-1.0, 1.0}};
  StreamMedian error_difference_;
};

// The pairs of every condition, estimator and thing compared; of the reference with itself too, which no one
// reads.
class AllPairs {
 public:
  AllPairs(const RunDescription& run, size_t reference, const std::vector<Compared>& compared)
      : bounds_(run.failure),
        reference_(reference),
        num_estimators_(run.estimators.size()),
        compared_(compared) {
    for (size_t cell = 0; cell < run.conditions.size() * num_estimators_; ++cell) {
      for (const Compared& each : compared_) cells_.emplace_back(each.kind);
    }
  }

  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    ++num_trials_;
    is_weighted_ = is_weighted_ || problem.weight != 1.0;
    for (size_t v = 0; v < compared_.size(); ++v) {
      const std::optional<double> of_reference = compared_[v].of(records[reference_], bounds_);
      if (!of_reference) continue;
      for (size_t e = 0; e < num_estimators_; ++e) {
        const std::optional<double> of_estimator = compared_[v].of(records[e], bounds_);
        if (of_estimator) cells_[IndexOfCell(problem.condition, e, v)].Add(*of_estimator, *of_reference);
      }
    }
  }

  const Pairs& Of(size_t condition, size_t estimator, size_t compared) const {
    return cells_[IndexOfCell(condition, estimator, compared)];
  }
  std::int64_t num_trials() const { return num_trials_; }
  bool is_weighted() const { return is_weighted_; }

 private:
  size_t IndexOfCell(size_t condition, size_t estimator, size_t compared) const {
    return (condition * num_estimators_ + estimator) * compared_.size() + compared;
  }

  FailureBounds bounds_;
  size_t reference_, num_estimators_;
  std::vector<Compared> compared_;
  std::vector<Pairs> cells_;
  std::int64_t num_trials_ = 0;
  bool is_weighted_ = false;
};

// One family: whoever reads the tables reads all of them, and Holm's procedure holds however the tests depend
// on each other (an event and its union with another do). A comparison without trials is no test: it costs
// the others nothing.
void AdjustForAllTests(std::vector<ComparisonRow>* rows) {
  std::vector<ComparisonRow*> tested;
  std::vector<double> p_values;
  for (ComparisonRow& row : *rows) {
    if (row.n == 0) continue;
    tested.push_back(&row);
    p_values.push_back(row.p_value);
  }
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  for (size_t i = 0; i < tested.size(); ++i) tested[i]->holm_p_value = adjusted[i];
}

}  // namespace

Comparison Compare(const ResultStore& store, const std::string& reference, const CompareOptions& options) {
  const RunDescription run = store.Description();
  const std::vector<DescribedEstimator>& estimators = run.estimators;
  const size_t reference_index = IndexOf(reference, run);
  const std::vector<Compared> compared = ComparedByName(options.compared);
  AllPairs pairs(run, reference_index, compared);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    pairs.Add(problem, records);
  });
  Comparison comparison{run.study,
                        estimators[reference_index].label,
                        run.factors,
                        compared,
                        {},
                        pairs.num_trials(),
                        run.NumTrials(),
                        {}};
  if (pairs.is_weighted()) {
    comparison.caution =
        "trials are weighted (tilted_to): counts of them say nothing, so there are none here";
    return comparison;
  }
  const bool is_anytime_valid = options.is_anytime_valid || !run.stopping_rule.empty();
  for (std::uint32_t c = 0; c < run.conditions.size(); ++c) {
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (e == reference_index) continue;
      for (size_t v = 0; v < compared.size(); ++v) {
        ComparisonRow row;
        row.condition = c;
        row.levels = run.conditions[c].levels;
        row.estimator = estimators[e].label;
        row.event = compared[v].name;
        pairs.Of(c, e, v).Fill(is_anytime_valid, &row);
        comparison.rows.push_back(std::move(row));
      }
    }
  }
  AdjustForAllTests(&comparison.rows);
  return comparison;
}

}  // namespace rcme
