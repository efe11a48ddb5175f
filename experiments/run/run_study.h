#pragma once

#include "experiments/run/store/result_store.h"
#include "experiments/core/work/shard.h"
#include "experiments/study/study_plan.h"

namespace rcme {

struct RunReport {
  std::int64_t num_trials = 0;   // of the study, or of the shard
  std::int64_t num_run_now = 0;  // the others were in the file already
  double seconds = 0.0;
};

// Runs every trial of the plan, or of one shard of it, that the store does not hold yet, on `num_threads`
// threads (0: one per core), and shows progress. The records do not depend on the number of threads or on the
// order in which trials end. Memory does not grow with the number of trials. An error or Stopped ends it; the
// trials before are kept.
RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store, const Shard& shard = {});

}  // namespace rcme
