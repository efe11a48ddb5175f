#include "experiments/statistics/compare.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "experiments/statistics/population_summary.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "stats/constants.h"
#include "stats/moments.h"
#include "stats/multiple_testing.h"
#include "stats/population_mean.h"
#include "stats/population_median.h"
#include "stats/population_rate.h"
#include "stats/score_mean.h"
#include "stats/stream_median.h"

namespace rcme {
namespace {

// Collects the pairs of values of one estimator and the reference for one compared quantity, trial by trial.
class ComparedPairs {
 public:
  ComparedPairs(ComparedKind kind, bool has_repeats) : kind_(kind), has_repeats_(has_repeats) {}

  void Add(double first, double second, bool is_first_of_scene);
  void EndScene();

  // Sets the numbers of a row.
  void Fill(bool is_anytime_valid, ComparisonRow* row) const;
  // The same for all draws of a population together, with intervals for the population
  // (stats/population_rate.h). The interval of an event is that of the difference of two rates, "only the
  // estimator" and "only the reference"; that of a score is Student's over draws; that of an error's median
  // is Woodruff's (population_median.h). The p-value is the least level at which the interval does not
  // contain 0; for an error this is the interval of the share of greater errors minus the share of smaller
  // ones.
  static void FillOfPopulation(std::span<const ComparedPairs> draws, ComparisonRow* row);

 private:
  bool IsByMeans() const {
    return kind_ == ComparedKind::kScore || (kind_ == ComparedKind::kEvent && has_repeats_);
  }
  double PValueOfCounts(bool is_anytime_valid) const;
  Interval AnytimeRiskDifferenceInterval() const;
  void FillEvent(ComparisonRow* row) const;
  void FillMeans(ComparisonRow* row) const;
  void FillError(ComparisonRow* row) const;
  void Merge(const ComparedPairs& other);

  ComparedKind kind_;
  bool has_repeats_;
  PairedCounts counts_;
  SceneMean scene_;                         // of the current scene
  ScoreMean mean_difference_{{-1.0, 1.0}};  // over the means of scenes
  Moments difference_;                      // over the means of scenes
  StreamMedian error_difference_;
};

// Finds, by bisection, the least level (to 1e-6) at which an interval does not contain 0. `interval_at`
// returns the interval of a confidence; these intervals are nested.
double FindPValue(double value, const std::function<Interval(double)>& interval_at) {
  if (value == 0.0) return 1.0;
  double excluded = 1.0, included = 1e-6;  // at level 1 the interval is the value itself
  if (!interval_at(1.0 - included).Contains(0.0)) return included;
  while (excluded - included > 1e-6 + 1e-3 * excluded) {
    const double level = std::sqrt(excluded * included);
    (interval_at(1.0 - level).Contains(0.0) ? included : excluded) = level;
  }
  return excluded;
}

constexpr ConditionWeights kWeights = ConditionWeights::kByTrials;

void ComparedPairs::Add(double first, double second, bool is_first_of_scene) {
  if (kind_ == ComparedKind::kEvent) counts_.Add(first != 0.0, second != 0.0);
  if (kind_ != ComparedKind::kError) {
    scene_.Add(first - second);
  } else if (is_first_of_scene) {
    counts_.Add(first > second, second > first);
    error_difference_.Add(first == second ? 0.0 : first - second);  // two infinite errors are equal
  }
}

void ComparedPairs::EndScene() {
  const std::optional<double> mean = scene_.Take();
  if (!mean || !IsByMeans()) return;
  mean_difference_.Add(*mean);
  difference_.Add(*mean);
}

void ComparedPairs::Fill(bool is_anytime_valid, ComparisonRow* row) const {
  row->kind = kind_;
  row->is_anytime_valid = is_anytime_valid || IsByMeans();
  row->is_of_scenes = has_repeats_;
  row->counts = counts_;
  if (IsByMeans()) {
    FillMeans(row);
  } else if (kind_ == ComparedKind::kEvent) {
    FillEvent(row);
  } else {
    FillError(row);
  }
  if (row->n == 0) row->p_value = std::nan("");
  row->holm_p_value = row->p_value;
}

double ComparedPairs::PValueOfCounts(bool is_anytime_valid) const {
  return is_anytime_valid ? AnytimeMcNemarPValue(counts_) : McNemarExactPValue(counts_);
}

void ComparedPairs::FillEvent(ComparisonRow* row) const {
  row->n = counts_.n();
  row->difference = row->n > 0 ? counts_.RiskDifference() : std::nan("");
  row->p_value = PValueOfCounts(row->is_anytime_valid);
  row->interval = row->is_anytime_valid ? AnytimeRiskDifferenceInterval() : RiskDifferenceInterval(counts_);
}

void ComparedPairs::FillMeans(ComparisonRow* row) const {
  row->n = mean_difference_.n();
  row->difference = mean_difference_.mean();
  row->p_value = mean_difference_.PValue(0.0);
  row->interval = mean_difference_.Sequence();
}

// The sign test is McNemar's test of the event "greater than the other". The interval of the median requires
// a fixed number of trials.
void ComparedPairs::FillError(ComparisonRow* row) const {
  row->n = error_difference_.n();
  row->difference = error_difference_.median();
  row->p_value = PValueOfCounts(row->is_anytime_valid);
  row->interval = row->is_anytime_valid || row->n == 0 ? Interval{std::nan(""), std::nan("")}
                                                       : error_difference_.interval();
}

Interval ComparedPairs::AnytimeRiskDifferenceInterval() const {
  ScoreMean difference({-1.0, 1.0});
  difference.Add(1.0, counts_.first_only);
  difference.Add(-1.0, counts_.second_only);
  difference.Add(0.0, counts_.both + counts_.neither);
  return difference.Sequence();
}

void ComparedPairs::Merge(const ComparedPairs& other) {
  counts_.Merge(other.counts_);
  difference_.Merge(other.difference_);
  error_difference_.Merge(other.error_difference_);
}

void ComparedPairs::FillOfPopulation(std::span<const ComparedPairs> draws, ComparisonRow* row) {
  ComparedPairs all(draws.front().kind_, false);
  std::vector<ConditionPair> counts;
  std::vector<Moments> differences;
  for (const ComparedPairs& draw : draws) {
    all.Merge(draw);
    counts.push_back({draw.counts_.first_only, draw.counts_.second_only, draw.counts_.n()});
    differences.push_back(draw.difference_);
  }
  row->kind = all.kind_;
  row->is_of_population = true;
  row->counts = all.counts_;
  row->n = all.IsByMeans() ? all.difference_.n() : all.counts_.n();
  row->difference = row->p_value = row->holm_p_value = kNaN;
  row->interval = {kNaN, kNaN};
  if (row->n == 0) return;
  const auto interval_at = [&](double confidence) {
    return all.IsByMeans() ? MeasurePopulationMean(differences, kWeights, confidence).interval
                           : MeasurePopulationDifference(counts, kWeights, confidence).interval;
  };
  row->difference = all.IsByMeans() ? all.difference_.mean() : all.counts_.RiskDifference();
  row->interval = interval_at(0.95);
  row->p_value = FindPValue(row->difference, interval_at);
  if (all.kind_ == ComparedKind::kError) {
    std::vector<const StreamMedian*> medians;
    for (const ComparedPairs& draw : draws) medians.push_back(&draw.error_difference_);
    row->difference = all.error_difference_.median();
    row->interval = MeasurePopulationMedian(medians).interval;
  }
  row->holm_p_value = row->p_value;
}

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
                        IsTargetOpen(run),
                        is_pooled && !is_of_population && IsSampleOfPopulation(run.identity)};
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
