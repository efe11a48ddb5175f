// Every estimator against one of them, the reference, on the same trials: how much more often does it fail,
// how much higher does it score, how much greater are its errors, and is that more than chance?
//
// Where the number of trials was fixed beforehand, events have Tango's interval and McNemar's exact test, and
// errors the interval of the median and the sign test. Where it depended on the outcomes (--until), or
// somebody has looked again and again, both promise too much: then the discordant trials, which a coin
// decides if the estimators are alike, are tested by the likelihood ratio of a mixture to the fair coin
// (stats/confidence_sequence.h), and differences have the intervals of betting (stats/score_mean.h), which
// hold at every look. Scores have these always.
//
// Where scenes are repeated (Study::repeats_per_scene), the trials of one are not independent: events and
// scores are compared by the means over a scene's pairs, with the tests and intervals of scores, errors by
// the first trial of each scene.
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
  std::vector<std::string> compared = {"events"};  // as ComparedByName takes them
  Pooling pooling = Pooling::kPerCondition;
  bool is_anytime_valid = false;  // even where the number of trials was fixed beforehand
};

// One event, score or error of one estimator and the reference in one condition.
struct ComparisonRow {
  std::uint32_t condition = 0;
  std::vector<std::string> levels;  // one per factor
  std::string estimator;            // label
  ComparedKind kind = ComparedKind::kEvent;
  std::string event;  // name of the event, score or error
  bool is_anytime_valid = false;
  bool is_of_population = false;  // interval and p (compared_pairs.h)
  bool is_of_scenes = false;      // of repeated scenes: n counts them, `counts` their trials
  std::int64_t n = 0;             // trials in which both count
  PairedCounts counts;            // first: the estimator, second: the reference; of events
  double difference = 0.0;        // estimator minus reference; NaN where n is 0
  Interval interval;              // of the difference: 95 %; NaN where there is none
  double p_value = 0.0;           // of no difference; NaN where n is 0
  double holm_p_value = 0.0;      // the same, adjusted for all rows of the comparison that have trials
};

struct Comparison {
  std::string study, reference;
  std::vector<std::string> factor_names;
  std::vector<Compared> compared;
  std::vector<ComparisonRow> rows;  // by condition, estimator, event; none in a study of one estimator
  std::int64_t num_trials_done = 0, num_trials_planned = 0;
  std::string caution;  // why there are no rows; empty: no reason
};

// Pooled: all trials of all conditions as if they were of one, which has no levels. Where the conditions are
// a sample of a population, intervals and p-values are of that (compared_pairs.h).
//
// One pass over the raw trials, in memory that does not grow with them. `reference` is a label of the study;
// empty: its first. Throws InputError if the study has no such label, or ComparedByName does.
Comparison Compare(const ReadableRun& run, const std::string& reference, const CompareOptions& options = {});
Comparison Compare(const ResultStore& store, const std::string& reference,
                   const CompareOptions& options = {});

}  // namespace rcme
