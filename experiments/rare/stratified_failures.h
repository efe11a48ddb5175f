// Failure rates from plain trials. Hard trials are run and most easy ones are not: stratification by the
// Cramer-Rao bound.
//
// The scene and the outliers of a trial are drawn as usual, and the bound of its motion is computed. This
// takes about 10 microseconds, an estimator up to milliseconds. If errors were normal with this covariance,
// the probability of failure would be
//   p = max over rotation and direction of P(|Normal(0, lambda)| > bound),  lambda the greatest eigenvalue,
// and Neyman's allocation would run trials in proportion to sqrt(p), the standard deviation of the outcome.
// So the trials are divided into strata k = 0, ..., 6, of which one in 2^k is run. 2^-k is near
// sqrt(p / p_hard), but at least 1 / 64. A pilot sets p_hard such that the wanted share of all trials is run.
// A trial that is run counts 2^k times.
//
// Whether a trial is run is drawn from a stream of its own and never depends on its outcome. So the estimate
// is unbiased for any estimator, noise and outliers, whether or not p is related to failures. The gain
// depends on this relation: if hard scenes cause the failures, it is up to the ratio of the costs. If they do
// not (wrong modes in easy scenes), there is no gain or a loss, and an interval from the failures that were
// seen is too short: it knows nothing of the easy strata without one. `cautious_upper` does.
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
  std::uint32_t num_trials = 100'000;  // trials drawn per condition
  double run_share = 0.1;              // wanted share of them that is run
};

struct StratumCount {
  std::int64_t num_trials = 0, num_run = 0, num_failed = 0;
};

// One estimator in one condition.
struct StratifiedCell {
  size_t condition = 0, estimator = 0;
  std::array<StratumCount, kNumStrata> strata;
  std::int64_t num_run = 0;
  std::int64_t num_not_simulated = 0;  // of the trials drawn; they are in no stratum (trial/simulate_draw.h)
  // Its cautious_upper is the upper end as if the next failure were in the easiest stratum with a trial that
  // was run.
  WeightedRate rate;
};

// The greater of the two probabilities above, from a bound (5x5, [rotation, direction], rad^2).
double FailureChanceOfBound(const Matrix5d& bound, const FailureBounds& bounds);

// The runner's work: an item is a hundred trials of a condition. Throws InputError for match files and
// repeated scenes.
WorkPlan PlanStrata(const StudyPlan& plan, const StratifiedEffort& effort);

// Trials 0, ..., num_trials - 1 of every condition, as `rcme run` would draw them. Throws as Runner::Get.
std::vector<StratifiedCell> StratifyFailures(const StudyPlan& plan, const StratifiedEffort& effort,
                                             Runner* runner);

}  // namespace rcme
