// Describes a column of the result file. Its storage, the check of values that are read, the documentation,
// the CSV of trials and Python's data frame all use this description.
#pragma once

#include <limits>

namespace rcme {

// The allowed values of a numeric column; by default all values of its type.
struct ColumnRange {
  double min = -std::numeric_limits<double>::infinity(), max = std::numeric_limits<double>::infinity();
  bool may_be_unknown = true;  // NaN, stored as NULL; whole numbers are always known

  bool Contains(double value) const { return value >= min && value <= max; }
};

// Only numbers on which estimators have no influence are limited; what an estimator reports about itself may
// be anything.
inline constexpr ColumnRange kAnyNumber = {};
inline constexpr ColumnRange kNotNegative = {0.0};
inline constexpr ColumnRange kFromZeroToOne = {0.0, 1.0};
inline constexpr ColumnRange kAngleDeg = {0.0, 180.0};
inline constexpr ColumnRange kFiniteOrUnknown = {0.0, std::numeric_limits<double>::max()};
inline constexpr ColumnRange kFiniteAndKnown = {0.0, std::numeric_limits<double>::max(), false};

struct StoredColumn {
  // kTime: differs in every run, so comparisons of trials leave it out.
  enum class Role { kKey, kNumber, kTime };

  const char* name;
  const char* unit;  // empty: no unit
  const char* meaning;
  ColumnRange range = kAnyNumber;
  Role role = Role::kNumber;
};

}  // namespace rcme
