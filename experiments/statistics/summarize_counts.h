#pragma once

#include <string>

#include "experiments/statistics/run_counts.h"
#include "experiments/statistics/summarize.h"

namespace rcme {

// Opens a file that keeps counts, and checks all of it. Throws InputError.
RunCounts OpenCounts(const std::string& path);
// Returns whether a result file keeps counts; false also if it cannot be read.
bool KeepsCounts(const std::string& path);

// Returns the summary that the trials themselves would give (summary_cell.h).
Summary SummarizeCounts(const RunCounts& counts, bool with_times, Pooling pooling = Pooling::kPerCondition);

}  // namespace rcme
