// Failure rates from plain trials of which hard ones are run and most easy ones are not: stratification by
// the Cramer-Rao bound.
//
// A trial's scene and outliers are drawn as ever, and the bound of its motion is computed: some 10
// microseconds, where an estimator may take milliseconds. If errors were normal with that covariance, the
// failure would have the probability
//   p = max over rotation and direction of P(|Normal(0, lambda)| > bound),  lambda the greatest eigenvalue,
// and Neyman's allocation would run trials in proportion to sqrt(p), the standard deviation of the outcome.
// So the trials form strata k = 0, ..., 6, of which one in 2^k is run, with 2^-k near sqrt(p / p_hard), never
// below 1 / 64; p_hard is set by a pilot such that a wanted share of all is run. A trial that is run counts
// 2^k times.
//
// Whether a trial is run is drawn from a stream of its own, never from its outcome: the estimate is unbiased
// whether or not p has to do with failures, and for any estimator, noise and outliers. What is gained depends
// on both: where failures are a matter of hard scenes it is up to the ratio of the costs, where they are not
// (wrong modes in easy scenes) it is nothing or less, and the interval says so.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "experiments/core/work/runner.h"
#include "experiments/study/study_plan.h"
#include "stats/weighted_rate.h"

namespace rcme {

inline constexpr int kNumStrata = 7;  // stratum k: one trial in 2^k is run

struct StratifiedEffort {
  std::uint32_t num_trials = 100'000;  // drawn, per condition
  double run_share = 0.1;              // of them, wanted
};

struct StratumCount {
  std::int64_t num_trials = 0, num_run = 0, num_failed = 0;
};

// One estimator in one condition.
struct StratifiedCell {
  size_t condition = 0, estimator = 0;
  std::array<StratumCount, kNumStrata> strata;
  std::int64_t num_run = 0;
  std::int64_t num_not_simulated = 0;  // of the trials drawn: in no stratum (trial/simulate_draw.h)
  WeightedRate
      rate;  // cautious_upper: as if the next failure were in the easiest stratum of which a trial was run
};

// The greatest of the two probabilities above, from a bound (5x5, [rotation, direction], rad^2).
double FailureChanceOfBound(const Matrix5d& bound, const FailureBounds& bounds);

// The runner's work: an item is a hundred trials of a condition. Throws InputError: match files; repeated
// scenes.
WorkPlan PlanStrata(const StudyPlan& plan, const StratifiedEffort& effort);

// Trials 0, ..., num_trials - 1 of every condition, as `rcme run` would draw them. Throws as Runner::Get.
std::vector<StratifiedCell> StratifyFailures(const StudyPlan& plan, const StratifiedEffort& effort,
                                             Runner* runner);

}  // namespace rcme
