#include "experiments/statistics/summarize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "experiments/statistics/scene_split.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/statistics/truth_quality.h"
#include "stats/confidence_sequence.h"
#include "stats/moments.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"
#include "stats/weighted_rate.h"

namespace rcme {
namespace {

void FillRate(std::int64_t num_trials, SummaryRow* row) {
  const std::int64_t successes = row->n > 0 ? std::llround(row->value * static_cast<double>(row->n)) : 0;
  row->interval = row->interval_kind == IntervalKind::kExact ? ExactBinomialInterval(successes, row->n)
                                                             : ConfidenceSequence(successes, row->n);
  if (row->n == 0) return;
  row->value = static_cast<double>(successes) / static_cast<double>(row->n);
  if (row->quantity != "nees_coverage") return;
  const bool is_of_fixed_n = row->interval_kind == IntervalKind::kExact;
  row->coverage_verdict = JudgeCoverage(row->value, row->interval, row->n, num_trials, is_of_fixed_n);
}

// Its interval is of a number of trials that was fixed beforehand.
void FillMedian(const StreamMedian& median, SummaryRow* row) {
  row->value = median.median();
  row->n = median.n();
  row->interval =
      row->interval_kind == IntervalKind::kExact ? median.interval() : Interval{std::nan(""), std::nan("")};
}

}  // namespace

void FillRow(const Collected& collected, std::int64_t num_trials, SummaryRow* row) {
  row->value = collected.mean;
  row->n = collected.n;
  if (collected.median) {
    FillMedian(*collected.median, row);
  } else if (collected.scores) {
    row->interval_kind = IntervalKind::kBetting;
    row->interval = collected.scores->Sequence();
  } else if (row->kind == SummaryRow::Kind::kRate) {
    FillRate(num_trials, row);
  } else {
    row->standard_error = collected.standard_error;
  }
}

namespace {

// The quantities of one estimator, or of the problems, in one condition, growing trial by trial.
template <typename Record>
class Accumulator {
 public:
  Accumulator(const std::vector<Quantity<Record>>& quantities, bool has_repeats)
      : quantities_(quantities), has_repeats_(has_repeats) {}

  void Add(const Record& record, double weight, bool is_first_of_scene, const FailureBounds& bounds) {
    is_weighted_ = is_weighted_ || weight != 1.0;
    for (size_t q = 0; q < quantities_.size(); ++q) {
      const std::optional<double> value = quantities_[q].contribution(record, bounds);
      if (!value) continue;
      scene_[q].Add(*value);
      if (!is_first_of_scene) continue;
      if (quantities_[q].kind == SummaryRow::Kind::kRate) weighted_[q].Add(weight, *value != 0.0);
      if (quantities_[q].kind == SummaryRow::Kind::kMedian) medians_[q].Add(*value);
    }
  }

  void EndScene() {
    ++num_scenes_;
    for (size_t q = 0; q < quantities_.size(); ++q) {
      const std::optional<double> mean = scene_[q].Take();
      if (!mean) continue;
      moments_[q].Add(*mean);
      if (IsScore(quantities_[q].kind)) scores_[q].Add(*mean);
    }
  }

  // `cell` holds what the rows share.
  void AppendRows(const SummaryRow& cell, std::vector<SummaryRow>* rows) const {
    for (size_t q = 0; q < moments_.size(); ++q) {
      SummaryRow row = cell;
      row.quantity = quantities_[q].name;
      row.kind = quantities_[q].kind;
      if (is_weighted_) row.interval_kind = IntervalKind::kWeighted;
      const bool is_median = row.kind == SummaryRow::Kind::kMedian;
      if (is_weighted_ && !is_median) {
        FillWeighted(q, &row);
      } else {
        const StreamMedian none;  // no median of weighted trials
        FillRow({moments_[q].n(), moments_[q].mean(), moments_[q].standard_error(),
                 !is_median     ? nullptr
                 : is_weighted_ ? &none
                                : &medians_[q],
                 IsScore(row.kind) ? &scores_[q] : nullptr},
                num_scenes_, &row);
      }
      rows->push_back(std::move(row));
    }
  }

 private:
  // The means of scenes are no zeros and ones.
  bool IsScore(SummaryRow::Kind kind) const {
    return kind == SummaryRow::Kind::kScore || (kind == SummaryRow::Kind::kRate && has_repeats_);
  }

  void FillWeighted(size_t q, SummaryRow* row) const {
    row->value = moments_[q].mean();
    row->n = moments_[q].n();
    const bool is_of_all = weighted_[q].num_trials == num_scenes_;
    const WeightedRate rate = EstimateWeightedRate(is_of_all ? weighted_[q] : WeightedEvents());
    row->n = is_of_all ? row->n : 0;
    row->value = is_of_all ? std::min(rate.estimate, 1.0) : std::numeric_limits<double>::quiet_NaN();
    row->standard_error = is_of_all ? rate.standard_error : row->value;
    row->interval = {std::min(rate.interval.lower, 1.0), std::min(rate.cautious_upper, 1.0)};
  }

  const std::vector<Quantity<Record>>& quantities_;
  bool has_repeats_;
  std::vector<SceneMean> scene_{quantities_.size()};  // so far
  std::vector<Moments> moments_{quantities_.size()};  // of the means of scenes
  std::vector<WeightedEvents> weighted_{quantities_.size()};
  std::vector<StreamMedian> medians_{quantities_.size()};
  std::vector<ScoreMean> scores_{quantities_.size()};
  std::int64_t num_scenes_ = 0;
  bool is_weighted_ = false;
};

// One condition. All trials of a scene have one problem: it is counted once, as if nothing were repeated.
class Cell {
 public:
  Cell(size_t num_estimators, int repeats_per_scene)
      : estimators_(num_estimators,
                    Accumulator<TrialRecord>(TrialQuantities(), /*has_repeats=*/repeats_per_scene > 1)) {
    if (repeats_per_scene > 1) splits_.assign(num_estimators, SceneSplit(repeats_per_scene));
  }

  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool is_first_of_scene,
           const FailureBounds& bounds) {
    if (is_first_of_scene) {
      problems_.Add(problem, problem.weight, true, bounds);
      problems_.EndScene();
    }
    for (size_t e = 0; e < estimators_.size(); ++e)
      estimators_[e].Add(records[e], problem.weight, is_first_of_scene, bounds);
    for (size_t e = 0; e < splits_.size(); ++e) splits_[e].Add(records[e], bounds);
  }
  void EndScene() {
    for (Accumulator<TrialRecord>& estimator : estimators_) estimator.EndScene();
    for (SceneSplit& split : splits_) split.EndScene();
  }

  // `cell` holds what the rows share but for the estimator.
  void AppendRows(const RunDescription& run, SummaryRow cell, std::vector<SummaryRow>* rows) const {
    for (size_t e = 0; e < estimators_.size(); ++e) {
      cell.estimator = run.estimators[e].label;
      estimators_[e].AppendRows(cell, rows);
      if (!splits_.empty()) splits_[e].AppendRows(cell, rows);
    }
    cell.estimator = kSceneLabel;
    problems_.AppendRows(cell, rows);
  }

 private:
  std::vector<Accumulator<TrialRecord>> estimators_;
  std::vector<SceneSplit> splits_;  // one per estimator; none without repeats
  Accumulator<ProblemRecord> problems_{ProblemQuantities(), /*has_repeats=*/false};
};

template <typename Record>
void AppendHelp(const std::vector<Quantity<Record>>& quantities, std::vector<QuantityHelp>* rows) {
  for (const Quantity<Record>& q : quantities) {
    rows->push_back({q.name, KindName(q.kind), q.doc});
  }
}

}  // namespace

const std::vector<QuantityHelp>& SummaryQuantities() {
  static const std::vector<QuantityHelp> help = [] {
    std::vector<QuantityHelp> rows;
    AppendHelp(TrialQuantities(), &rows);
    for (const QuantityHelp& split : SceneSplitQuantities()) rows.push_back(split);
    AppendHelp(ProblemQuantities(), &rows);
    return rows;
  }();
  return help;
}

bool HasFailureProbabilities(const Summary& summary) {
  return std::ranges::any_of(
      summary.rows, [](const SummaryRow& row) { return row.quantity == "failure_probability" && row.n > 0; });
}

std::string KindName(SummaryRow::Kind kind) {
  switch (kind) {
    case SummaryRow::Kind::kRate:
      return "rate";
    case SummaryRow::Kind::kMean:
      return "mean";
    case SummaryRow::Kind::kMedian:
      return "median";
    case SummaryRow::Kind::kScore:
      return "score";
    case SummaryRow::Kind::kVarianceShare:
      return "share";
  }
  return "";
}

Summary Summarize(const ResultStore& store, bool with_times, Pooling pooling) {
  return Summarize(store, with_times,
                   pooling == Pooling::kPooled ? OneGroup() : GroupByCondition(store.Description()));
}

std::vector<std::string> FindAlwaysRefusing(const Summary& summary) {
  std::vector<std::string> found;
  for (const auto& [label, effort] : summary.efforts) {
    // Of all trials are rates of both kinds of refusal, which exclude each other.
    std::map<std::uint32_t, double> refused;
    for (const SummaryRow& row : summary.rows) {
      const bool is_refusal = row.quantity == "no_candidate" || row.quantity == "other_refusal";
      if (row.estimator == label && is_refusal && row.n > 0) refused[row.condition] += row.value;
    }
    const auto is_all = [](const auto& of_condition) { return of_condition.second > 1.0 - 1e-9; };
    if (!refused.empty() && std::ranges::all_of(refused, is_all)) found.push_back(label);
  }
  return found;
}

Summary Summarize(const ResultStore& store, bool with_times, const TrialGroups& groups) {
  const RunDescription run = store.Description();
  Summary summary{run.study,
                  groups.factor_names,
                  {},
                  {},
                  0,
                  run.NumTrials(),
                  run.repeats_per_scene,
                  DescribeTruthQuality(run.identity)};
  for (const DescribedEstimator& estimator : run.estimators)
    summary.efforts.emplace_back(estimator.label, estimator.effort);
  summary.num_retried = run.retried_trials;
  std::vector<Cell> cells(groups.levels.size(), Cell(run.estimators.size(), run.repeats_per_scene));
  Cell* of_scene = nullptr;
  ForEachTrialByScene(
      store, run.repeats_per_scene,
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool is_first) {
        ++summary.num_trials_done;
        of_scene = &cells[groups.group_of(problem)];
        of_scene->Add(problem, records, is_first, run.failure);
      },
      [&](std::uint32_t) { of_scene->EndScene(); });
  for (std::uint32_t c = 0; c < cells.size(); ++c) {
    SummaryRow row;
    row.condition = c;
    row.levels = groups.levels[c];
    if (!run.stopping_rule.empty()) row.interval_kind = IntervalKind::kAnytimeValid;
    cells[c].AppendRows(run, row, &summary.rows);
  }
  LeaveOutRows(with_times, &summary);
  return summary;
}

}  // namespace rcme
