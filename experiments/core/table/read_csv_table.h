// Reads tables that a script of the program has written.
#pragma once

#include <string>

#include "experiments/core/table/table.h"

namespace rcme {

// Parses a CSV file: a heading line, then a line per row. A column has the first type that fits all its
// fields: integers, numbers, texts. An empty field in a column of numbers means "not known" (NaN).
Table ReadCsvTable(const std::string& text);

}  // namespace rcme
