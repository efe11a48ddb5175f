// The result of a command: rows under typed columns. A column describes everything that a renderer needs to
// know about its values; no renderer knows a quantity by its name.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

// A number with what says how far to trust it.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: not known
  Interval interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> n = std::nullopt;  // where it is not that of the row
  std::string note = {};                         // a verdict or a flag
  int decimals = -1;                             // for people; negative: those of the column
};

// Nothing: the row has no such value. It is an empty cell, and no key of a row in JSON.
using Value = std::variant<std::monostate, std::string, std::int64_t, double, bool, Interval, Estimate>;

enum class ColumnType { kText, kCount, kNumber, kFlag, kInterval, kEstimate };

// How numbers of a column are written; JSON has all digits of them.
struct NumberFormat {
  double scale = 1.0;
  std::string unit;            // "%"; in LaTeX it is in the heading
  std::string value = ".3g";   // of fmt, of a value and its interval
  std::string spread = ".2g";  // of a standard error
  std::string file = ".8g";    // of fmt, in CSV
};
inline const NumberFormat kPercent{100.0, "%", ".2f", ".2g"};
inline const NumberFormat kSignificant{};

inline constexpr const char* kNotInJson = "-";

struct Column {
  std::string name;  // in CSV; of an interval that of both ends: "lower,upper"; empty: not in CSV
  ColumnType type = ColumnType::kText;
  NumberFormat format = {};
  std::string json_name = {};  // empty: the name, of which an interval has "interval"
  std::string heading = {};    // for people; empty: the name
  std::string group = {};      // the object of JSON that holds it; empty: the row
  bool is_key = false;         // says what the row is of
  bool is_symbol = false;      // the heading is a symbol of mathematics

  static Column Key(const std::string& name) { return {.name = name, .is_key = true}; }
  static Column Text(const std::string& name) { return {.name = name}; }
  static Column Count(const std::string& name) { return {name, ColumnType::kCount}; }
  static Column Flag(const std::string& name) { return {name, ColumnType::kFlag}; }
  static Column Number(const std::string& name, const NumberFormat& format = kSignificant) {
    return {name, ColumnType::kNumber, format};
  }
  static Column Estimated(const std::string& name, const NumberFormat& format = kSignificant) {
    return {name, ColumnType::kEstimate, format};
  }

  const std::string& Heading() const { return heading.empty() ? name : heading; }
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Value>> rows = {};  // a value for each column

  void AddColumns(const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  }
};

// A column, and its value in a row made of an Item.
template <typename Item>
struct ColumnOf {
  Column column;
  std::function<Value(const Item&)> value;
};

template <typename Item, std::ranges::input_range Items>
Table MakeTable(const std::vector<ColumnOf<Item>>& columns, const Items& items) {
  Table table;
  for (const ColumnOf<Item>& column : columns) table.columns.push_back(column.column);
  for (const Item& item : items) {
    table.rows.emplace_back();
    for (const ColumnOf<Item>& column : columns) table.rows.back().push_back(column.value(item));
  }
  return table;
}

// A column per factor: its level, in JSON within the object `levels`. levels_of(item): a level per factor.
template <typename Item, typename LevelsOf>
std::vector<ColumnOf<Item>> LevelColumns(const std::vector<std::string>& factors, LevelsOf levels_of) {
  std::vector<ColumnOf<Item>> columns;
  for (size_t f = 0; f < factors.size(); ++f) {
    columns.push_back({{.name = factors[f], .group = "levels", .is_key = true},
                       [f, levels_of](const Item& item) { return levels_of(item).at(f); }});
  }
  return columns;
}
// Of items that have the member `levels`.
template <typename Item>
std::vector<ColumnOf<Item>> LevelColumns(const std::vector<std::string>& factors) {
  return LevelColumns<Item>(
      factors, [](const Item& item) -> const auto& { return item.levels; });
}

}  // namespace rcme
