// The two tables of records, problems and trials: their SQL, writing and reading a row. Everything about them
// follows from the fields of the records (trial_fields.h).
#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "experiments/run/store/column_meaning.h"
#include "experiments/run/store/column_range.h"
#include "experiments/core/files/database.h"
#include "experiments/run/store/schema.h"
#include "experiments/trial/trial_fields.h"

namespace rcme {

// `kNumExtra` columns are no fields; they come last.
template <typename Record>
struct RecordTable;
template <>
struct RecordTable<ProblemRecord> {
  static constexpr const char* kName = "problems";
  static constexpr const char* kKey = "condition, trial";
  static constexpr int kNumExtra = 1;  // the checksum
  static void Visit(auto& record, auto&& visit) { VisitProblemFields(record, visit); }
};
template <>
struct RecordTable<TrialRecord> {
  static constexpr const char* kName = "trials";
  static constexpr const char* kKey = "condition, trial, estimator";
  static constexpr int kNumExtra = 0;
  static void Visit(auto& record, auto&& visit) { VisitFields(record, visit); }
};

// "condition, trial, ..." with `make(name, field)` for each field.
template <typename Record, typename Make>
std::string JoinFields(Make make) {
  Record record;
  std::vector<std::string> parts;
  RecordTable<Record>::Visit(
      record, [&](const char* name, const auto& field) { parts.push_back(make(name, field)); });
  return fmt::format("{}", fmt::join(parts, ", "));
}

// The columns of the table, `extra` after those of the fields.
template <typename Record, typename... Extra>
std::vector<ResultColumn> RecordColumns(const Extra&... extra) {
  std::vector<ResultColumn> columns;
  Record record;
  RecordTable<Record>::Visit(record, [&](const char* name, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    const char* type = std::is_same_v<Field, double>         ? "REAL"
                       : std::is_same_v<Field, MotionStatus> ? "TEXT"
                                                             : "INTEGER";
    const bool may_be_null = std::is_same_v<Field, double> && RangeOf(name).may_be_unknown;
    const ColumnMeaning& meaning = MeaningOf(name);
    columns.push_back({name, type, meaning.unit, meaning.text, may_be_null});
  });
  (columns.push_back(extra), ...);
  return columns;
}

template <typename Record>
std::string InsertIntoRecordTable() {
  using Table = RecordTable<Record>;
  return fmt::format("INSERT INTO {} VALUES ({}{})", Table::kName,
                     JoinFields<Record>([](const char*, const auto&) { return "?"; }),
                     Table::kNumExtra > 0 ? ", ?" : "");
}

// `rest` begins with " WHERE" or " ORDER BY"; empty: all rows, in the table's own order.
template <typename Record>
std::string SelectFromRecordTable(const std::string& rest = {}) {
  return fmt::format("SELECT * FROM {}{} ORDER BY {}", RecordTable<Record>::kName, rest,
                     RecordTable<Record>::kKey);
}

// Binds the fields; returns the number of the parameter after them.
template <typename Record>
int BindFields(SQLite::Statement& statement, const Record& record) {
  int parameter = 1;
  RecordTable<Record>::Visit(record, [&](const char*, const auto& field) {
    using Field = std::decay_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, MotionStatus>) {
      statement.bindNoCopy(parameter, StatusName(field));
    } else if constexpr (std::is_same_v<Field, double>) {
      statement.bind(parameter, field);  // NaN becomes NULL
    } else {
      statement.bind(parameter, static_cast<std::int64_t>(field));
    }
    ++parameter;
  });
  return parameter;
}

// One field of a row.
inline void ReadField(const SQLite::Column& column, const char* table, const ColumnRange& range,
                      double* field) {
  *field = std::numeric_limits<double>::quiet_NaN();
  if (column.isNull() && range.may_be_unknown) return;
  if (!column.isFloat()) ThrowWrongType(column, table, "a real number");
  *field = column.getDouble();
  if (!range.Contains(*field)) ThrowOutOfRange(column, table);
}

inline void ReadField(const SQLite::Column& column, const char* table, const ColumnRange&,
                      MotionStatus* field) {
  const std::string name = TextIn(column, table);
  for (const MotionStatus status : AllStatuses()) {
    if (StatusName(status) != name) continue;
    *field = status;
    return;
  }
  ThrowOutOfRange(column, table);
}

template <typename Integer>
void ReadField(const SQLite::Column& column, const char* table, const ColumnRange& range, Integer* field) {
  using Limits = std::numeric_limits<Integer>;
  const std::int64_t value = IntegerIn(column, table);
  if (value < Limits::min() || value > Limits::max() || !range.Contains(static_cast<double>(value)))
    ThrowOutOfRange(column, table);
  *field = static_cast<Integer>(value);
}

// The record of the current row of SelectFromRecordTable. Throws Damage if a column is of the wrong type, out
// of its range or, where a number is always known, NULL.
template <typename Record>
Record ReadRecord(SQLite::Statement& row) {
  using Table = RecordTable<Record>;
  static const std::vector<ColumnRange> ranges = [] {
    std::vector<ColumnRange> all;
    Record record;
    Table::Visit(record, [&](const char* name, const auto&) { all.push_back(RangeOf(name)); });
    return all;
  }();
  Record record;
  int index = 0;
  Table::Visit(record, [&](const char*, auto& field) {
    ReadField(row.getColumn(index), Table::kName, ranges[static_cast<size_t>(index)], &field);
    ++index;
  });
  return record;
}

}  // namespace rcme
