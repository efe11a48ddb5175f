#pragma once

#include <string>

#include "experiments/run/run_trials.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// RunTrials into a file that keeps counts (run_counts.h), which is opened or made for this run alone. The
// counts are written every ten seconds and at the end, completely or not at all; a trial lost when the
// process is killed is not counted and is computed again. Throws InputError for weighted trials and repeated
// scenes, which counts cannot represent, and if the run does not continue the file.
RunReport CountStudy(const StudyPlan& plan, int num_threads, const std::string& path,
                     const Shard& shard = {});

}  // namespace rcme
