#include "experiments/core/table/table.h"

namespace rcme {

Table WithIntervalColumns(const Table& table) {
  Table wide;
  wide.rows.resize(table.rows.size());
  for (size_t c = 0; c < table.columns.size(); ++c) {
    wide.columns.push_back(table.columns[c]);
    for (size_t r = 0; r < table.rows.size(); ++r) wide.rows[r].push_back(table.rows[r][c]);
    if (table.columns[c].type != ColumnType::kEstimate) continue;
    wide.columns.push_back(Column::Bounds(table.columns[c].name));
    for (size_t r = 0; r < table.rows.size(); ++r)
      wide.rows[r].emplace_back(std::get<Estimate>(table.rows[r][c]).interval);
  }
  return wide;
}

}  // namespace rcme
