// Reads and writes the tables of records, `problems` and `trials`. Everything follows from the columns of
// the records (trial_columns.h).
#pragma once

#include <fmt/format.h>

#include <limits>
#include <string>
#include <type_traits>
#include <vector>

#include "experiments/core/files/database.h"
#include "experiments/run/store/schema.h"
#include "experiments/trial/trial_columns.h"

namespace rcme {

// `kNumExtra` is the number of last columns that are not fields.
template <typename Record>
struct RecordTable;
template <>
struct RecordTable<ProblemRecord> {
  static constexpr const char* kName = "problems";
  static constexpr const char* kKey = "condition, trial";
  static constexpr size_t kNumExtra = 1;  // the checksum
};
template <>
struct RecordTable<TrialRecord> {
  static constexpr const char* kName = "trials";
  static constexpr const char* kKey = "condition, trial, estimator";
  static constexpr size_t kNumExtra = 0;
};

// Describes how the file stores a field.
template <typename Field>
ResultColumn DescribeColumn(const StoredColumn& column, const Field&) {
  const char* type = std::is_same_v<Field, double>         ? "REAL"
                     : std::is_same_v<Field, MotionStatus> ? "TEXT"
                                                           : "INTEGER";
  const bool may_be_null = std::is_same_v<Field, double> && column.range.may_be_unknown;
  return {column.name, type, column.unit, column.meaning, may_be_null};
}

// Returns the columns of the table without the extra ones.
template <typename Record>
std::vector<ResultColumn> RecordColumns() {
  std::vector<ResultColumn> columns;
  const Record record;
  VisitColumns(record, [&](const StoredColumn& column, const auto& field) {
    columns.push_back(DescribeColumn(column, field));
  });
  return columns;
}

template <typename Record>
std::string InsertIntoRecordTable() {
  const std::vector<const char*> places(RecordColumns<Record>().size() + RecordTable<Record>::kNumExtra, "?");
  return fmt::format("INSERT INTO {} VALUES ({})", RecordTable<Record>::kName, fmt::join(places, ", "));
}

// `rest` begins with " WHERE"; empty: all rows. The rows are ordered by the key.
template <typename Record>
std::string SelectFromRecordTable(const std::string& rest = {}) {
  return fmt::format("SELECT * FROM {}{} ORDER BY {}", RecordTable<Record>::kName, rest,
                     RecordTable<Record>::kKey);
}

// Binds the fields and returns the number of the next parameter.
template <typename Record>
int BindFields(SQLite::Statement& statement, const Record& record) {
  int parameter = 1;
  VisitColumns(record, [&](const StoredColumn&, const auto& field) {
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

// Reads one field of a row.
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

// Reads the record in the current row of SelectFromRecordTable. Throws Damage if a column has a wrong type,
// is out of range, or is NULL although its number is always known.
template <typename Record>
Record ReadRecord(SQLite::Statement& row) {
  Record record;
  int index = 0;
  VisitColumns(record, [&](const StoredColumn& column, auto& field) {
    ReadField(row.getColumn(index++), RecordTable<Record>::kName, column.range, &field);
  });
  return record;
}

}  // namespace rcme
