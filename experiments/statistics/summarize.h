#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/core/text/shared_text.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/boxed_optional.h"
#include "experiments/statistics/coverage_verdict.h"
#include "experiments/statistics/preregistration.h"
#include "experiments/statistics/trial_groups.h"
#include "stats/constants.h"
#include "stats/intervals.h"

namespace rcme {

// Which intervals rates and scores have.
enum class IntervalKind : std::uint8_t {
  kExact,         // Clopper-Pearson
  kAnytimeValid,  // confidence sequence: the number of trials depended on their outcomes
  kWeighted,      // of weighted trials, with the cautious upper end (stats/weighted_rate.h)
  kBetting,       // of scores: a confidence sequence, whatever the number of trials depended on
  kLogStudent,    // of shares (stats/variance_split.h)
  kPopulation     // of the population that the conditions are a sample of (population_summary.h)
};

// Of pooled draws of a population: the interval for these very conditions, each tried for ever, and how
// many independent trials would tell as much of the population (Kish's effective n).
struct PopulationPart {
  Interval of_these_conditions = {kNaN, kNaN};
  double effective_n = kNaN;
};

// One number of one estimator in one condition, never without what says how far to trust it. A summary may
// have millions of them.
struct SummaryRow {
  enum class Kind : std::uint8_t {
    kRate,
    kMean,
    kMedian,
    kScore,          // mean of numbers in [0, 1]
    kVarianceShare,  // of a variance (scene_split.h)
    kArea            // between two curves (error_ranking.h)
  };

  SharedText estimator;  // label; kSceneLabel: of the problem, whoever solves it
  SharedText quantity;
  std::uint32_t condition = 0;
  Kind kind = Kind::kRate;
  IntervalKind interval_kind = IntervalKind::kExact;
  bool is_of_split = false;     // what the scene and what the sampler decides (scene_split.h)
  double value = 0.0;           // NaN where n is 0
  Interval interval;            // all but means: 95 %; NaN where a median's or an area's would not hold
  double standard_error = 0.0;  // means, areas and rates of weighted trials: Monte-Carlo standard error
  std::int64_t n = 0;           // trials that the number is of; of repeated scenes: scenes
  BoxedOptional<CoverageVerdict> coverage_verdict;  // of a coverage with trials and an interval
  BoxedOptional<PopulationPart> of_population;      // of pooled draws of one
};

std::string KindName(SummaryRow::Kind kind);  // "rate", "mean", "median", "score", "share", "area"

// Stands in the place of an estimator in rows about the problems themselves.
inline constexpr const char* kSceneLabel = "scene";

struct Summary {
  std::string study;
  std::vector<std::string> factor_names;
  std::vector<std::vector<std::string>> levels;  // of every condition, one per factor
  Settings efforts;  // of each estimator, by label: what limits the work of a call; empty: unknown
  std::vector<SummaryRow> rows;
  std::int64_t num_trials_done = 0, num_trials_planned = 0;
  int repeats_per_scene = 1;
  std::string truth_quality;      // truth_quality.h
  bool is_of_population = false;  // its intervals are (population_summary.h)
  std::string population;         // DescribePopulation of study/population.h
  std::int64_t num_retried = 0;   // trials that were run again (RunDescription::retried_trials)
  std::optional<Preregistration> preregistration;  // where somebody asked for it (preregistration.h)
};

// Whether an estimator of the run states probabilities of failure.
bool HasFailureProbabilities(const Summary& summary);

// The estimators that refused every trial of every condition.
std::vector<std::string> FindAlwaysRefusing(const Summary& summary);

// A quantity of the summary, for `rcme list quantities`.
struct QuantityHelp {
  std::string name, kind, doc;
};
const std::vector<QuantityHelp>& SummaryQuantities();

// Where the trials of a condition are weighted, only the rates of all trials are given: of a part of the
// trials they would be ratios of estimates.
//
// Where scenes are repeated, every scene counts once: with the mean over its repeats in rates, scores and
// means, with its first trial in medians. The means of scenes are independent numbers, so that rates have
// the intervals of scores.
//
// Every quantity of every estimator in every condition, then those of the problems, from the raw trials, in
// one pass, in memory that does not grow with the trials but for the ranking of errors (error_ranking.h).
// Times (which no two runs share) only if asked for.
//
// Pooled: all trials of all conditions as if they were of one, which has no levels. Intervals are then of
// these very conditions; where the conditions are a sample of a population, of that (population_summary.h).
Summary Summarize(const ResultStore& store, bool with_times, Pooling pooling = Pooling::kPerCondition);
// The same with the trials put together otherwise.
Summary Summarize(const ResultStore& store, bool with_times, const TrialGroups& groups);

}  // namespace rcme
