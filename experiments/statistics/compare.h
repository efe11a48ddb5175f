// Compares every estimator with a reference on the same trials: how much more often it fails, how much
// higher it scores, how much greater its errors are, and whether the difference is significant.
//
// If the number of trials was fixed beforehand, events have Tango's interval and McNemar's exact test;
// errors have the interval of the median and the sign test. Both are wrong if the number depended on the
// outcomes (--until) or if somebody looked repeatedly. Then the discordant trials, which are fair coin flips
// if the estimators are equally good, are tested by a likelihood ratio of a mixture to the fair coin
// (stats/confidence_sequence.h). Differences of rates then have betting intervals (stats/score_mean.h),
// medians of errors none. These tests and intervals hold at every look. Scores always have betting
// intervals.
//
// If scenes are repeated (Study::repeats_per_scene), the trials of a scene depend on each other. Events and
// scores are then compared by the mean over a scene's pairs, with the tests and intervals of scores; errors
// are compared by the first trial of each scene.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "experiments/statistics/compared.h"
#include "experiments/statistics/readable_run.h"
#include "experiments/statistics/trial_groups.h"
#include "stats/intervals.h"
#include "stats/paired.h"

namespace rcme {

struct CompareOptions {
  std::vector<std::string> compared = {"events"};  // names that ComparedByName accepts
  Pooling pooling = Pooling::kPerCondition;
  bool is_anytime_valid = false;  // even if the number of trials was fixed beforehand
};

// The comparison of one estimator with the reference by one event, score or error in one condition.
struct ComparisonRow {
  std::uint32_t condition = 0;
  std::vector<std::string> levels;  // one level per factor
  std::string estimator;            // label
  ComparedKind kind = ComparedKind::kEvent;
  std::string event;  // name of the event, score or error
  bool is_anytime_valid = false;
  bool is_of_population = false;  // interval and p are those of the population
  bool is_of_scenes = false;      // scenes are repeated: n counts scenes, `counts` their trials
  std::int64_t n = 0;             // trials that count for both estimators
  PairedCounts counts;            // of events; first: the estimator, second: the reference
  double difference = 0.0;        // estimator minus reference; NaN if n is 0
  Interval interval;              // 95 % interval of the difference; NaN if there is none
  double p_value = 0.0;           // of no difference; NaN if n is 0
  double holm_p_value = 0.0;      // p_value adjusted for all rows of the comparison with trials
};

struct Comparison {
  std::string study, reference;
  std::vector<std::string> factor_names;
  std::vector<Compared> compared;
  std::vector<ComparisonRow> rows;  // by condition, estimator, event; empty for one estimator
  std::int64_t num_trials_done = 0, num_trials_planned = 0;
  std::string caution;             // why there are no rows; empty if there is no reason
  bool is_target_open = false;     // `rcme run --until` has not ended
  bool is_of_these_draws = false;  // pooled draws of a population without intervals of it
};

// Compares in one pass over the raw trials, in memory that does not grow with them. `reference` is a label
// of the study; empty: its first estimator. Pooled, all trials of all conditions count as those of one
// condition without levels; if the conditions are a sample of a population, intervals and p-values are those
// of the population (stats/population_rate.h). Throws InputError if the study does not have the label, or as
// ComparedByName does.
Comparison Compare(const ReadableRun& run, const std::string& reference, const CompareOptions& options = {});
Comparison Compare(const ResultStore& store, const std::string& reference,
                   const CompareOptions& options = {});

}  // namespace rcme
