#include "experiments/statistics/compare.h"

#include <fmt/format.h>

#include "experiments/statistics/compared_pairs.h"
#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/study/estimator_spec.h"
#include "stats/multiple_testing.h"

namespace rcme {
namespace {

// The pairs of every group, estimator and compared quantity. The pairs of the reference with itself are
// collected too, but not used.
class AllPairs {
 public:
  AllPairs(const RunDescription& run, const TrialGroups& groups, size_t reference,
           const std::vector<Compared>& compared)
      : bounds_(run.failure),
        groups_(groups),
        reference_(reference),
        num_estimators_(run.estimators.size()),
        compared_(compared) {
    for (size_t cell = 0; cell < groups.levels.size() * num_estimators_; ++cell) {
      for (const Compared& each : compared_) cells_.emplace_back(each.kind, run.repeats_per_scene > 1);
    }
  }

  void Add(const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool is_first_of_scene) {
    ++num_trials_;
    group_ = groups_.group_of(problem);
    is_weighted_ = is_weighted_ || problem.weight != 1.0;
    for (size_t v = 0; v < compared_.size(); ++v) {
      const std::optional<double> of_reference = compared_[v].of(records[reference_], bounds_);
      if (!of_reference) continue;
      for (size_t e = 0; e < num_estimators_; ++e) {
        const std::optional<double> of_estimator = compared_[v].of(records[e], bounds_);
        if (!of_estimator) continue;
        cells_[IndexOfCell(group_, e, v)].Add(*of_estimator, *of_reference, is_first_of_scene);
      }
    }
  }

  void EndScene() {
    for (size_t i = IndexOfCell(group_, 0, 0); i < IndexOfCell(group_ + 1, 0, 0); ++i) cells_[i].EndScene();
  }

  const ComparedPairs& Of(size_t group, size_t estimator, size_t compared) const {
    return cells_[IndexOfCell(group, estimator, compared)];
  }
  std::vector<ComparedPairs> OfAllGroups(size_t estimator, size_t compared) const {
    std::vector<ComparedPairs> all;
    for (size_t group = 0; group < groups_.levels.size(); ++group)
      all.push_back(Of(group, estimator, compared));
    return all;
  }
  std::int64_t num_trials() const { return num_trials_; }
  bool is_weighted() const { return is_weighted_; }

 private:
  size_t IndexOfCell(size_t group, size_t estimator, size_t compared) const {
    return (group * num_estimators_ + estimator) * compared_.size() + compared;
  }

  FailureBounds bounds_;
  const TrialGroups& groups_;
  size_t group_ = 0;  // group of the last trial
  size_t reference_, num_estimators_;
  std::vector<Compared> compared_;
  std::vector<ComparedPairs> cells_;
  std::int64_t num_trials_ = 0;
  bool is_weighted_ = false;
};

// All tests are one family, because a reader of the tables sees all of them. Holm's procedure holds however
// the tests depend on each other (an event and a union that contains it do). A comparison without trials is
// no test, so it does not weaken the others.
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
  return Compare(ReadRun(store), reference, options);
}

Comparison Compare(const ReadableRun& readable, const std::string& reference, const CompareOptions& options) {
  const RunDescription& run = readable.description;
  const std::vector<DescribedEstimator>& estimators = run.estimators;
  const size_t reference_index =
      reference.empty()
          ? 0
          : FindEstimator(run.estimators, reference, fmt::format("--against: study '{}'", run.study));
  const std::vector<Compared> compared = ComparedByName(options.compared);
  const bool is_anytime_valid = options.is_anytime_valid || !run.stopping_rule.empty();
  const bool is_pooled = options.pooling == Pooling::kPooled;
  if (is_pooled) CheckMayBePooled(run);
  const bool is_of_population = is_pooled && !is_anytime_valid && HasPopulationIntervals(run);
  const TrialGroups groups =
      is_of_population ? GroupByDraw(run) : (is_pooled ? OneGroup() : GroupByCondition(run));
  AllPairs pairs(run, groups, reference_index, compared);
  ForEachTrialByScene(
      readable,
      [&](const ProblemRecord& problem, const std::vector<TrialRecord>& records, bool is_first) {
        pairs.Add(problem, records, is_first);
      },
      [&](std::uint32_t) { pairs.EndScene(); });
  Comparison comparison{run.study,
                        estimators[reference_index].label,
                        is_pooled ? std::vector<std::string>() : groups.factor_names,
                        compared,
                        {},
                        pairs.num_trials(),
                        run.NumTrials(),
                        {},
                        IsTargetOpen(run)};
  if (pairs.is_weighted()) {
    comparison.caution = "trials are weighted (tilted_to), so this comparison has no counts of them";
    return comparison;
  }
  const std::size_t num_conditions = is_pooled ? 1 : groups.levels.size();
  for (std::uint32_t c = 0; c < num_conditions; ++c) {
    for (size_t e = 0; e < estimators.size(); ++e) {
      if (e == reference_index) continue;
      for (size_t v = 0; v < compared.size(); ++v) {
        ComparisonRow row;
        row.condition = c;
        if (!is_pooled) row.levels = groups.levels[c];
        row.estimator = estimators[e].label;
        row.event = compared[v].name;
        if (is_of_population) {
          ComparedPairs::FillOfPopulation(pairs.OfAllGroups(e, v), &row);
        } else {
          pairs.Of(c, e, v).Fill(is_anytime_valid, &row);
        }
        comparison.rows.push_back(std::move(row));
      }
    }
  }
  AdjustForAllTests(&comparison.rows);
  return comparison;
}

}  // namespace rcme
