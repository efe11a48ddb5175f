#pragma once

#include <limits>
#include <string>

namespace rcme {

// What a column of numbers may hold; by default what its type can.
struct ColumnRange {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool may_be_unknown = true;  // NaN, stored as NULL; whole numbers are always known

  bool Contains(double value) const { return value >= min && value <= max; }
};

// Of a column of the tables problems and trials, by its name. Only what no estimator has a say in is limited:
// numbers that an estimator reports about itself may be anything.
ColumnRange RangeOf(const std::string& column);

}  // namespace rcme
