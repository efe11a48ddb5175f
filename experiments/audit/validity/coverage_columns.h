// The last columns of the tables of the map: coverage with its exact 95 % interval.
#pragma once

#include <string>
#include <vector>

#include "experiments/core/table/table.h"
#include "stats/intervals.h"

namespace rcme {

// `format` of fmt; empty: as many digits as were given.
inline NumberFormat MakeCsvFormat(const std::string& format) {
  NumberFormat number;
  number.file = format;
  return number;
}

inline std::vector<Column> CoverageColumns() {
  const NumberFormat format = MakeCsvFormat(".4f");
  return {Column::Number("coverage", format), {"lower,upper", ColumnType::kInterval, format}};
}

// Leaves the columns empty if n is zero.
inline void AddCoverage(std::int64_t num_covered, std::int64_t n, std::vector<Value>* row) {
  if (n == 0) return row->resize(row->size() + 2);
  row->emplace_back(static_cast<double>(num_covered) / static_cast<double>(n));
  row->emplace_back(ExactBinomialInterval(num_covered, n));
}

}  // namespace rcme
