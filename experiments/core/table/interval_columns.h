// Interval columns for table files.
#pragma once

#include "experiments/core/table/table.h"

namespace rcme {

// Adds a column with the interval after each column of estimates: "NAME_lower,NAME_upper" in CSV,
// "NAME_interval" in JSON.
Table WithIntervalColumns(const Table& table);

}  // namespace rcme
