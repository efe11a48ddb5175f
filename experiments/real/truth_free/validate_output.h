#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/validate.h"

namespace rcme {

// "holds", "too small by 2.1 [1.8, 2.5] in variance", "undecided: 1.3 [0.9, 1.9]".
std::string DescribeVerdict(const TruthFreeTest& test);

std::string ValidationAsTable(const std::vector<SetReport>& reports);
// One row for each set and test, including sigma and the correlations.
Table MakeValidationTable(const std::vector<SetReport>& reports);
// The rows of MakeValidationTable. JSON also has a table of the sets and one each of their loops, tests,
// correlations, camera faults and advice.
CommandResult MakeValidationResult(const std::vector<SetReport>& reports);

}  // namespace rcme
