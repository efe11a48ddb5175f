// Failure rates far below what can be counted, by multilevel splitting.
#pragma once

#include <vector>

#include "experiments/core/work/progress.h"
#include "experiments/rare/failing_motion.h"
#include "stats/splitting_rate.h"

namespace rcme {

struct RareEffort {
  SplittingEffort splitting;
  int num_replicates = 20;  // at least 2
};

// One estimator in one condition.
struct RareCell {
  size_t condition = 0, estimator = 0;
  SplittingPilot pilot;
  std::vector<SplittingReplicate> replicates;
  SplittingRate rate;
};

// The rate of failure (HasFailed) of every estimator in every condition, the estimators of the first
// condition first. A replicate is a pure function of (study, seed, condition, estimator, effort, its number),
// `seed` in the place of the study's. Throws InputError as FailingMotion does; a request to stop ends it as
// Stopped.
std::vector<RareCell> SplitFailures(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort,
                                    int num_threads, Progress* progress);

}  // namespace rcme
