#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/marginals.h"

namespace rcme {

// Makes a table with a row per regime and quantity.
Table MakeMarginalsTable(const Marginals& marginals);

// For people: every estimator over all conditions, then the `num_shown` regimes with the greatest excess.
// Files have the same rows.
CommandResult MakeMarginalsResult(const std::string& study, const Marginals& marginals, size_t num_shown);

}  // namespace rcme
