#pragma once

#include "experiments/run/run_trials.h"
#include "experiments/run/store/result_store.h"

namespace rcme {

// RunTrials with a store that keeps every record.
RunReport RunStudy(const StudyPlan& plan, int num_threads, ResultStore* store, const Shard& shard = {});

}  // namespace rcme
