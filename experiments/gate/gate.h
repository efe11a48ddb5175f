// Tests whether a new version of an estimator is worse than an old one by more than a margin. Both versions
// answer the same problems. Each trial gives one bounded difference per quantity; a betting test examines the
// mean difference (stats/score_mean.h). The verdict is
//
//   worse         if, for some quantity, the Holm-adjusted test at level alpha rejects "the difference is at
//                 most the margin"
//   not worse     if, for every quantity, the test at level alpha rejects "the difference is at least the
//                 margin"
//   undecided     if neither happens within the budget
//
// P(verdict "worse" at any look | no difference exceeds its margin) <= alpha. P(verdict "not worse" at any
// look | some difference exceeds its margin) <= alpha without adjustment, because the hypothesis of that very
// quantity has to be rejected.
//
// A round is one trial of every condition; a look uses a whole number of rounds. The difference under test is
// the mean over the conditions of the study, equally weighted. The trials of a round are independent with
// means mu_c. The expected growth of the bettor's capital in a round is prod_c (1 + f (mu_c / m - 1)). By the
// inequality of arithmetic and geometric means it is at most 1 if the mean of mu_c is at most m, so the
// capital is a supermartingale over rounds. Trials without a pair leave the capital unchanged; the mean is
// then that of the trials with a pair. Trials that share a scene count as one, by their mean.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/gate/gate_quantity.h"
#include "experiments/statistics/readable_run.h"
#include "stats/constants.h"
#include "stats/intervals.h"

namespace rcme {

inline constexpr double kGateLevel = 0.05;  // alpha

enum class GateVerdict { kNotWorse, kWorse, kUndecided, kNotMeasured };
std::string Name(GateVerdict verdict);  // "not worse", ...

// One test at a look.
struct GateRow {
  GateTest test;
  std::int64_t n = 0;                 // pairs (for a limit: trials), or scenes if trials share them
  double of_old = 0.0, of_new = 0.0;  // rate, mean score or median over the pairs; NaN: unknown
  double difference = 0.0;            // in the units of the margin; for a limit: the rate
  Interval interval;         // each end holds at every look with probability 1 - alpha, both with 1 - 2 alpha
  double size_ratio = kNaN;  // for miscoverage: geometric mean over pairs of new / old region size
  double p_worse = 1.0, p_not_worse = 1.0;  // p_worse is Holm-adjusted
  GateVerdict verdict = GateVerdict::kUndecided;
};

struct GateLook {
  std::int64_t num_rounds = 0;  // trials of every condition
  std::vector<GateRow> rows;    // one per test, in their order
  GateVerdict verdict = GateVerdict::kUndecided;
};

// Tests the first `num_rounds` trials of every condition. The old version is the run's first estimator, the
// new version its last; a run of one estimator allows only limits. A test without a pair is not measured, and
// the others decide. Throws InputError if trials are weighted.
GateLook TakeGateLook(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t num_rounds);

// Extends the run to `num_rounds` trials of every condition; false: the time limit was reached.
using GrowRun = std::function<bool(std::int64_t num_rounds)>;

// Looks after about 200 trials, at least 20 of every condition, and then each time after a quarter more,
// until the verdict is decided, `max_rounds` is reached or `grow` returns false. Without a first look every
// test is undecided after 0 trials. Throws InputError if no test is measured at `max_rounds`.
GateLook LookUntilDecided(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t max_rounds,
                          const GrowRun& grow);

// The largest n such that every condition has the trials 0, ..., n - 1.
std::int64_t CountRounds(const ReadableRun& run);

// A trial with different outcomes for the two versions.
struct ChangedTrial {
  std::uint32_t condition = 0, trial = 0;
  std::string of_old, of_new;  // outcomes (trial_event.h)
  bool is_for_worse = false;   // success became refusal or failure, or refusal became failure
};
// Trials that changed for the worse come first.
std::vector<ChangedTrial> FindChangedTrials(const ReadableRun& run, std::int64_t num_rounds);

}  // namespace rcme
