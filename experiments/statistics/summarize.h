#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/core/text/shared_text.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/coverage_verdict.h"
#include "experiments/statistics/preregistration.h"
#include "experiments/statistics/readable_run.h"
#include "experiments/statistics/trial_groups.h"
#include "stats/constants.h"
#include "stats/intervals.h"

namespace rcme {

// An optional value on the heap. It takes eight bytes in each of millions of rows, few of which have a
// value.
template <typename T>
class BoxedOptional {
 public:
  BoxedOptional() = default;
  BoxedOptional(T value) : value_(std::make_unique<T>(std::move(value))) {}
  BoxedOptional(const BoxedOptional& other) : value_(other ? std::make_unique<T>(*other) : nullptr) {}
  BoxedOptional(BoxedOptional&&) noexcept = default;
  BoxedOptional& operator=(BoxedOptional other) noexcept {
    value_ = std::move(other.value_);
    return *this;
  }

  explicit operator bool() const { return value_ != nullptr; }
  bool has_value() const { return value_ != nullptr; }
  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  // Throws std::bad_optional_access if there is no value.
  const T& value() const { return value_ ? *value_ : throw std::bad_optional_access(); }

 private:
  std::unique_ptr<T> value_;
};

// The kinds of intervals of rates and scores.
enum class IntervalKind : std::uint8_t {
  kExact,         // Clopper-Pearson
  kAnytimeValid,  // confidence sequence, because the number of trials depended on their outcomes
  kWeighted,      // for weighted trials, with the cautious upper end (stats/weighted_rate.h)
  kBetting,       // for scores: a confidence sequence, whether or not the number of trials was fixed
  kLogStudent,    // for shares of a variance (stats/variance_split.h)
  kPopulation     // for the population from which the conditions are sampled (population_summary.h)
};

// For pooled draws of a population: the interval for these conditions alone, with infinitely many trials
// each, and the number of independent trials with the same information about the population (Kish's
// effective n).
struct PopulationPart {
  Interval of_these_conditions = {kNaN, kNaN};
  double effective_n = kNaN;
};

// One quantity of one estimator in one condition, with its uncertainty. A summary may have millions of rows.
struct SummaryRow {
  enum class Kind : std::uint8_t {
    kRate,
    kMean,
    kMedian,
    kScore,          // mean of numbers in [0, 1]
    kVarianceShare,  // share of a variance (scene_split.h)
    kArea            // area between two curves (error_ranking.h)
  };

  SharedText estimator;  // label; kSceneLabel: of the problem itself
  SharedText quantity;
  std::uint32_t condition = 0;
  Kind kind = Kind::kRate;
  IntervalKind interval_kind = IntervalKind::kExact;
  bool is_of_split = false;     // split between scene and sampler (scene_split.h)
  double value = 0.0;           // NaN if n is 0
  Interval interval;            // 95 %; not for means; NaN for a median or an area if it would not hold
  double standard_error = 0.0;  // Monte-Carlo standard error, for means, areas and rates of weighted trials
  std::int64_t n = 0;           // trials that count for the quantity; scenes if scenes are repeated
  BoxedOptional<CoverageVerdict> coverage_verdict;  // of a coverage with trials and an interval
  BoxedOptional<PopulationPart> of_population;      // for pooled draws of a population
};

std::string KindName(SummaryRow::Kind kind);  // "rate", "mean", "median", "score", "share", "area"

// The estimator's label in rows about the problems themselves.
inline constexpr const char* kSceneLabel = "scene";

struct Summary {
  std::string study;
  std::vector<std::string> factor_names;
  std::vector<std::vector<std::string>> levels;  // of every condition, one level per factor
  Settings efforts;                              // by label: what limits the work of a call; empty: not known
  std::vector<std::string> outside;  // labels of estimators outside the program (study/estimator_spec.h)
  std::vector<SummaryRow> rows;
  std::int64_t num_trials_done = 0, num_trials_planned = 0;
  bool is_target_open = false;  // `rcme run --until` has not ended
  int repeats_per_scene = 1;
  std::string truth_quality;      // truth_quality.h
  bool is_of_population = false;  // intervals are for the population (population_summary.h)
  bool is_of_these_draws =
      false;               // pooled draws of a population without such intervals (HasPopulationIntervals)
  std::string population;  // DescribePopulation of study/population.h
  // If pooled: conditions all of whose trials the simulator could not make, and conditions that have trials.
  std::int64_t num_conditions_not_simulated = 0, num_conditions_with_trials = 0;
  std::int64_t num_retried = 0;  // trials that were run again (RunDescription::retried_trials)
  std::optional<Preregistration> preregistration;  // if requested (preregistration.h)
};

// Returns whether any estimator of the run states failure probabilities.
bool HasFailureProbabilities(const Summary& summary);

// Returns the estimators that refused every trial of every condition.
std::vector<std::string> FindAlwaysRefusing(const Summary& summary);

// A quantity of the summary, for `rcme list quantities`.
struct QuantityHelp {
  std::string name, kind, doc;
  std::string base;  // the trials, answers or problems that count, in words
};
const std::vector<QuantityHelp>& SummaryQuantities();

// Summarizes every quantity of every estimator in every condition, then those of the problems, in one pass
// over the raw trials. Memory does not grow with the trials, except for the ranking of errors
// (error_ranking.h). Times, which differ in every run, are included only if requested.
//
// Pooled, all trials of all conditions count as those of one condition without levels. Intervals are then
// for these conditions; if the conditions are a sample of a population, for the population
// (population_summary.h).
//
// If the trials of a condition are weighted, only rates over all trials are given: rates over a part of them
// would be ratios of estimates.
//
// If scenes are repeated, every scene counts once: by the mean over its repeats in rates, scores and means,
// by its first trial in medians. The means of scenes are independent numbers, so rates have the intervals of
// scores.
Summary Summarize(const ReadableRun& run, bool with_times, Pooling pooling = Pooling::kPerCondition);
Summary Summarize(const ResultStore& store, bool with_times, Pooling pooling = Pooling::kPerCondition);
// Pooled, once for each level of a factor of the run. Throws InputError for another name.
Summary SummarizeBy(const ReadableRun& run, bool with_times, const std::string& factor);
// The same for each of the groups of GroupByFifth, which hold trials of several conditions. Throws InputError
// where conditions share their scenes.
Summary SummarizeFifths(const ReadableRun& run, bool with_times, const TrialGroups& fifths);
// The same with other groups of trials.
Summary Summarize(const ReadableRun& run, bool with_times, const TrialGroups& groups);

}  // namespace rcme
