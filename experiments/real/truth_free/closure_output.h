#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/real/truth_free/validate.h"

namespace rcme {

// One table for people for each set that has loops; empty if none has.
std::string ClosuresAsTable(const std::vector<SetReport>& reports);
// One row for each set and entry of its closures. `estimator` labels the rows and may be empty.
Table MakeClosureTable(const std::vector<SetReport>& reports, const std::string& estimator = "");

}  // namespace rcme
