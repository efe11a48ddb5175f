#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/marginals.h"

namespace rcme {

// For people: every estimator over all conditions, then the `num_shown` regimes farthest from what is
// claimed.
std::string MarginalsAsTable(const std::string& study, const Marginals& marginals, size_t num_shown);
// All of them.
std::string MarginalsAsCsv(const Marginals& marginals);
std::string MarginalsAsJson(const std::string& study, const Marginals& marginals);

CommandResult MakeMarginalsResult(const std::string& study, const Marginals& marginals, size_t num_shown);

}  // namespace rcme
