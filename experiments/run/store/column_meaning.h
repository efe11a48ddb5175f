#pragma once

#include <string>

namespace rcme {

// A column of the tables problems and trials in words, for the page of the format.
struct ColumnMeaning {
  std::string unit, text;  // unit empty: none
};

// By its name. Throws std::logic_error for a column that has none yet.
const ColumnMeaning& MeaningOf(const std::string& column);

}  // namespace rcme
