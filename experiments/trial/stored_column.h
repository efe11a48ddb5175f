// A column of the result file, described once. Its place in the file, the check of what is read, the pages of
// the documents, the CSV of trials and the data frame of Python all follow from this description.
#pragma once

#include <limits>

namespace rcme {

// What a column of numbers may hold; by default what its type can.
struct ColumnRange {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool may_be_unknown = true;  // NaN, stored as NULL; whole numbers are always known

  bool Contains(double value) const { return value >= min && value <= max; }
};

// Only what no estimator has a say in is limited: numbers that an estimator reports about itself may be
// anything.
inline constexpr ColumnRange kAnyNumber = {};
inline constexpr ColumnRange kNotNegative = {0.0};
inline constexpr ColumnRange kFromZeroToOne = {0.0, 1.0};
inline constexpr ColumnRange kAngleDeg = {0.0, 180.0};
inline constexpr ColumnRange kFiniteOrUnknown = {0.0, std::numeric_limits<double>::max()};
inline constexpr ColumnRange kFiniteAndKnown = {0.0, std::numeric_limits<double>::max(), false};

struct StoredColumn {
  // kTime: no two runs share it; what compares trials leaves it out.
  enum class Role { kKey, kNumber, kTime };

  const char* name;
  const char* unit;  // empty: none
  const char* meaning;
  ColumnRange range = kAnyNumber;
  Role role = Role::kNumber;
};

}  // namespace rcme
