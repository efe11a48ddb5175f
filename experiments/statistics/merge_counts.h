// The counts of shards as one. Counts of a trial cannot be taken away again: parts that have trials in common
// are refused, unless they hold the same in every number.
#pragma once

#include <string>
#include <vector>

#include "experiments/run/store/parts.h"

namespace rcme {

// As MergeResults and CheckParts (run/store/merge_results.h), of files that keep counts.
MergeReport MergeCounts(const std::vector<std::string>& parts, const std::string& out, bool is_partial,
                        const MergeOptions& options);
MergeReport CheckCounts(const std::vector<std::string>& parts, const MergeOptions& options);

}  // namespace rcme
