// Failure rates too low to be counted, by multilevel splitting.
#pragma once

#include <vector>

#include "experiments/core/work/runner.h"
#include "experiments/rare/failing_motion.h"
#include "stats/splitting_rate.h"

namespace rcme {

struct RareEffort {
  SplittingEffort splitting;
  int num_replicates = 20;  // at least 2
  RareEvent event = {};
};

// One estimator in one condition.
struct RareCell {
  size_t condition = 0, estimator = 0;
  SplittingPilot pilot;
  std::vector<SplittingReplicate> replicates;
  SplittingRate rate;
  // Of the first draws (FailingMotion). If no draw could be simulated, there is no pilot, and this is why.
  int num_not_simulated = 0;
  std::string why_not_simulated = {};
};

// The runner's work: the pilot of each cell, then its replicates.
WorkPlan PlanSplitting(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort);

// The rate of the event (for a failure: HasFailed) of every estimator in every condition; the estimators of
// the first condition come first. A replicate is a pure function of (study, seed, condition, estimator,
// effort, its number); `seed` replaces the study's. Throws InputError as FailingMotion does, and as
// Runner::Get.
std::vector<RareCell> SplitFailures(const StudyPlan& plan, std::uint64_t seed, const RareEffort& effort,
                                    Runner* runner);

}  // namespace rcme
