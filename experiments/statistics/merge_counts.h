// Merges the counts of shards. The counts of a single trial cannot be subtracted, so parts that share trials
// are refused, unless all their numbers are equal.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/store/parts.h"

namespace rcme {

// As MergeResults and CheckParts (run/store/merge_results.h), for files that keep counts.
MergeReport MergeCounts(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                        const MergeOptions& options);
MergeReport CheckCounts(const std::vector<std::string>& parts, const MergeOptions& options);

}  // namespace rcme
