// Tables that a script of the program has written.
#pragma once

#include <string>

#include "experiments/core/table/table.h"

namespace rcme {

// The table of a CSV file with a heading, a line per row. A column is of whole numbers, of numbers or of
// texts: the first that all its fields are; an empty field among numbers is not known.
Table ReadCsvTable(const std::string& text);

}  // namespace rcme
