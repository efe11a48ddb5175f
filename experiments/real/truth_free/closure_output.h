#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/real/truth_free/validate.h"

namespace rcme {

// Of each set that has loops a table for people; empty where none has.
std::string ClosuresAsTable(const std::vector<SetReport>& reports);
// A row per set and entry of its closures; `estimator`, which may be empty, tells several files apart.
Table MakeClosureTable(const std::vector<SetReport>& reports, const std::string& estimator = "");

}  // namespace rcme
