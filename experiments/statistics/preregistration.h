// Decides the hypotheses stated before a run, those of its lock or, without a lock, of its study, each with
// an interval and a verdict. Also reports how the run departs from the lock.
//
// A hypothesis is decided on the trials planned beforehand, the first ones of each condition. Trials added
// later do not count, because whoever added them may have seen the first. The verdict is open until all
// planned trials are done. The intervals are simultaneous (Bonferroni): all of them hold together with a
// confidence of at least 95 %, so the number of hypotheses needs no further correction.
//
// If the conditions are a sample of a population, the intervals are for the population
// (stats/population_rate.h, population_mean.h) and a draw counts once. Otherwise they are for the conditions
// at hand: exact (Clopper & Pearson) for a rate, which is conservative if conditions differ (Hoeffding
// 1956); Tango's for the difference of two rates; betting (stats/score_mean.h) for scores. If scenes are
// repeated, a scene counts once, as a score.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "experiments/statistics/stated_sharpness.h"
#include "experiments/study/stated_hypothesis.h"
#include "stats/intervals.h"

namespace rcme {

enum class HypothesisVerdict {
  kHolds,        // the whole interval satisfies the hypothesis
  kDoesNotHold,  // no part of the interval does
  kOpen
};
std::string Name(HypothesisVerdict verdict);  // "holds", "does not hold", "open"

struct DecidedHypothesis {
  StatedHypothesis stated;
  double value = 0.0;  // of the quantity or of the difference; NaN without trials
  Interval interval;   // simultaneous
  std::int64_t n = 0;  // trials; scenes if scenes are repeated
  std::int64_t num_conditions = 0;
  StatedSharpness sharpness, sharpness_against;  // of a coverage; else unknown
  HypothesisVerdict verdict = HypothesisVerdict::kOpen;
  std::string why_open;  // "50 of 100 trials are done"; empty: the interval decides
};

struct Preregistration {
  bool is_locked = false;
  std::string locked_at, program, sha256;  // of the lock
  std::vector<std::string> deviations;     // study_lock.h
  std::vector<std::string> reasons;        // reasons given for the deviations
  std::vector<DecidedHypothesis> hypotheses;
  double confidence = 0.95;       // of all intervals together
  double confidence_each = 0.95;  // of each
};

// Decides the hypotheses of a run. Nothing if the run has neither a lock nor hypotheses. Messages call the
// run `path`. Throws InputError if the lock does not have its hash.
std::optional<Preregistration> DecidePreregistered(const ResultStore& run, const std::string& path);
// The same from a description alone: every hypothesis is open.
std::optional<Preregistration> DescribePreregistered(const RunDescription& run, const std::string& path);

// Decides by the position of the interval.
HypothesisVerdict Decide(const StatedHypothesis& hypothesis, const Interval& interval);

}  // namespace rcme
