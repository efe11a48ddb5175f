#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_check/check_truth.h"

namespace rcme {

// A table of the scenes, then one of the pairs in doubt.
std::string TruthCheckAsText(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options);
// A row per pair and front end.
std::string TruthCheckAsJson(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options);
// The pairs in doubt, for the key truth_in_doubt of a study (experiments/data/truth_doubts.h).
std::string TruthDoubtsAsCsv(const std::vector<CheckedPair>& pairs);

CommandResult MakeTruthCheckResult(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options);

}  // namespace rcme
