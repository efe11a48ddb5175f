#pragma once

#include <vector>

#include "experiments/core/table/command_result.h"
#include "experiments/real/truth_free/validate.h"

namespace rcme {

// The tables of the JSON document: the sets, and one each of their loops, tests, correlations, closures,
// camera faults and advice.
std::vector<NamedTable> MakeValidationParts(const std::vector<SetReport>& reports);

}  // namespace rcme
