// Runs the trials of a study, whatever is kept of them.
#pragma once

#include <cstdint>

#include "experiments/core/work/shard.h"
#include "experiments/run/trial_keeper.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct RunReport {
  std::int64_t num_trials = 0;   // of the study or the shard
  std::int64_t num_run_now = 0;  // the others had been kept before
  double seconds = 0.0;
};

// Runs every trial of the plan, or of one shard, that has not been kept, on `num_threads` threads (0: one
// per core), and shows progress. The records do not depend on the number of threads or on the order in which
// trials finish. Memory does not grow with the number of trials. After an error or Stopped, the trials
// finished so far are kept.
RunReport RunTrials(const StudyPlan& plan, const Shard& shard, int num_threads, TrialKeeper* keeper);

}  // namespace rcme
