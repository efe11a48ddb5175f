// Is a new version of an estimator worse than an old one by more than a margin? Both answer the same
// problems, and each trial gives a bounded difference per quantity, on which a gambler bets
// (stats/score_mean.h):
//
//   worse         one test at level alpha, Holm-adjusted for all of them, rejects "the difference is at most
//                 the margin"
//   not worse     every test at level alpha rejects "the difference is at least the margin"
//   undecided     neither, within the budget
//
// P(worse is said at any look | no difference exceeds its margin) <= alpha, and P(not worse is said at any
// look | one does) <= alpha: that one has to be rejected itself, so that this needs no adjustment.
//
// A difference is of the mean over the conditions of the study, as they are. A look is at the same number of
// trials of every condition, a round being one of each. The trials of a round are independent with means
// mu_c, so that the expected growth of the capital, prod_c (1 + f (mu_c / m - 1)), is at most 1 where the
// mean of mu_c is at most m (arithmetic and geometric mean): the capital is a supermartingale over rounds.
// Trials that give no pair leave it as it is; the mean is then that over the trials that give one. Where
// trials share a scene they count as one, by their mean.
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
  std::int64_t n = 0;                 // pairs, of scenes where trials share them; of a limit trials
  double of_old = 0.0, of_new = 0.0;  // of these pairs: rates, mean scores, medians; NaN: not known
  double difference = 0.0;            // as people read it; of a limit the rate
  Interval interval;         // each end holds at every look with probability 1 - alpha, both with 1 - 2 alpha
  double size_ratio = kNaN;  // of miscoverage: the regions' size over the old ones', pair by pair
  double p_worse = 1.0, p_not_worse = 1.0;  // the first is Holm-adjusted
  GateVerdict verdict = GateVerdict::kUndecided;
};

struct GateLook {
  std::int64_t num_rounds = 0;  // trials of every condition
  std::vector<GateRow> rows;    // as the tests
  GateVerdict verdict = GateVerdict::kUndecided;
};

// What the first `num_rounds` trials of every condition say. The new version is the run's last estimator, the
// old one its first; of a run of one estimator only limits can be tested. Throws InputError where trials are
// weighted, or only one of the versions gives what a test needs.
GateLook TakeGateLook(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t num_rounds);

// Sees to it that the run has so many trials of every condition; false: the time is over.
using GrowRun = std::function<bool(std::int64_t num_rounds)>;

// Looks after about 200 trials and then after a quarter more each time, until the verdict is decided or
// `max_rounds` is reached. The numbers of trials depend on the study alone. If the time is over before the
// first look, every test is undecided after no trial.
GateLook LookUntilDecided(const ReadableRun& run, const std::vector<GateTest>& tests, std::int64_t max_rounds,
                          const GrowRun& grow);

// How many trials every condition has without a gap.
std::int64_t CountRounds(const ReadableRun& run);

// A trial that ended otherwise with the new version.
struct ChangedTrial {
  std::uint32_t condition = 0, trial = 0;
  std::string of_old, of_new;  // outcomes (trial_outcome.h)
  bool is_for_worse = false;   // a success was lost, or a failure came for a refusal
};
std::vector<ChangedTrial> FindChangedTrials(const ReadableRun& run, std::int64_t num_rounds);

}  // namespace rcme
