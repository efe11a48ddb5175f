// What was decided before a run, and what became of it: the hypotheses of its lock, or of its study where it
// has none, each with an interval and a verdict; and how the run departs from the lock.
//
// A hypothesis is decided on the trials that were asked for beforehand, the first so many of each condition:
// those that somebody added later, having seen the first, do not count. Until all of them are there the
// verdict is open. Intervals are simultaneous: all of them hold together with a confidence of at least 95 %
// (Bonferroni), so that the number of hypotheses needs no further correction.
//
// Intervals: where conditions are a sample of a population, those of the population (stats/population_rate.h,
// population_mean.h), a draw counts once. Else of the conditions at hand: exact (Clopper & Pearson) for a
// rate, which is cautious where conditions differ (Hoeffding 1956), Tango's for the difference of two rates,
// betting (stats/score_mean.h) for scores. Where scenes are repeated a scene counts once, as a score.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "experiments/study/stated_hypothesis.h"
#include "stats/intervals.h"

namespace rcme {

enum class HypothesisVerdict {
  kHolds,        // the whole interval is where the hypothesis says
  kDoesNotHold,  // none of it is
  kOpen
};
std::string Name(HypothesisVerdict verdict);  // "holds", "does not hold", "open"

struct DecidedHypothesis {
  StatedHypothesis stated;
  double value = 0.0;  // of the quantity, or of the difference; NaN without trials
  Interval interval;   // simultaneous
  std::int64_t n = 0;  // trials; of repeated scenes: scenes
  std::int64_t num_conditions = 0;
  HypothesisVerdict verdict = HypothesisVerdict::kOpen;
  std::string why_open;  // "50 of 100 trials are done"; empty: the interval
};

struct Preregistration {
  bool is_locked = false;
  std::string locked_at, program, sha256;  // of the lock
  std::vector<std::string> deviations;     // study_lock.h
  std::vector<std::string> reasons;        // that were given for them
  std::vector<DecidedHypothesis> hypotheses;
  double confidence = 0.95;       // of all intervals together
  double confidence_each = 0.95;  // of each
};

// Nothing where the run has neither a lock nor hypotheses. Throws InputError where the lock does not have its
// hash. `path` is what the messages call the run.
std::optional<Preregistration> DecidePreregistered(const ResultStore& run, const std::string& path);
// The same of a description alone: every hypothesis is open.
std::optional<Preregistration> DescribePreregistered(const RunDescription& run, const std::string& path);

// A verdict from where the interval lies.
HypothesisVerdict Decide(const StatedHypothesis& hypothesis, const Interval& interval);

}  // namespace rcme
