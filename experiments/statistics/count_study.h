#pragma once

#include <string>

#include "experiments/run/run_trials.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// RunTrials, into a file that keeps counts (run_counts.h): opened, or made, for this run alone. What has
// been counted is written every ten seconds and at the end, all of it or nothing: a trial that a kill took
// away is not counted, and computed again. Throws InputError for weighted trials and repeated scenes, which
// counts cannot tell apart, and where the file cannot be continued.
RunReport CountStudy(const StudyPlan& plan, int num_threads, const std::string& path,
                     const Shard& shard = {});

}  // namespace rcme
