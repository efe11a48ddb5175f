// Tables for files.
#pragma once

#include "experiments/core/table/table.h"

namespace rcme {

// The same with the interval of each estimate in a column of its own, after the estimate's: "NAME_lower,
// NAME_upper" in CSV, "NAME_interval" in JSON.
Table WithIntervalColumns(const Table& table);

}  // namespace rcme
