#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/validate.h"

namespace rcme {

std::string ValidationAsTable(const std::vector<SetReport>& reports);
// One row for each set and test, including sigma and the correlations.
Table MakeValidationTable(const std::vector<SetReport>& reports);
// The rows of MakeValidationTable. JSON also has a table each of the sets, their loops, tests, correlations,
// closures, camera faults and advice.
CommandResult MakeValidationResult(const std::vector<SetReport>& reports);

}  // namespace rcme
