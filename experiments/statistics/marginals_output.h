#pragma once

#include <string>

#include "experiments/core/table/command_result.h"
#include "experiments/statistics/marginals.h"

namespace rcme {

// A row per regime and quantity.
Table MakeMarginalsTable(const Marginals& marginals);

// For people every estimator over all conditions, then the `num_shown` regimes farthest from what is claimed;
// in files these rows.
CommandResult MakeMarginalsResult(const std::string& study, const Marginals& marginals, size_t num_shown);

}  // namespace rcme
