#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_check/check_truth.h"

namespace rcme {

// For people: a table of the scenes, then one of the pairs in doubt. In files: a row per pair and front end.
CommandResult MakeTruthCheckResult(const std::vector<CheckedPair>& pairs, const TruthCheckOptions& options);

// Lists the pairs in doubt, for the key truth_in_doubt of a study (experiments/data/truth_doubts.h).
std::string TruthDoubtsAsCsv(const std::vector<CheckedPair>& pairs);

}  // namespace rcme
