// The result of a command: rows under typed columns. A column tells renderers all they need to know about
// its values; no renderer knows a quantity by its name.
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

// A number and its uncertainty.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();  // NaN: not known
  Interval interval{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  double standard_error = std::numeric_limits<double>::quiet_NaN();
  std::optional<std::int64_t> n = std::nullopt;  // if not that of the row
  std::string note = {};                         // a verdict or a flag
  int decimals = -1;                             // decimals for people; negative: those of the column
};

// monostate: the row has no such value; the cell is empty, and the key is missing from the row in JSON.
using Value = std::variant<std::monostate, std::string, std::int64_t, double, bool, Interval, Estimate>;

enum class ColumnType { kText, kCount, kNumber, kFlag, kInterval, kEstimate };

// How the numbers of a column are formatted. JSON always has all digits.
struct NumberFormat {
  double scale = 1.0;
  std::string unit;            // such as "%"; LaTeX has it in the heading
  std::string value = ".3g";   // fmt format of a value and its interval
  std::string spread = ".2g";  // fmt format of a standard error
  std::string file = ".8g";    // fmt format in CSV
};
inline const NumberFormat kPercent{100.0, "%", ".2f", ".2g"};
inline const NumberFormat kSignificant{};

// As a json_name: the column is not written to JSON.
inline constexpr const char* kNotInJson = "-";

struct Column {
  std::string name;  // in CSV; an interval has the names of both ends: "lower,upper"; empty: not in CSV
  ColumnType type = ColumnType::kText;
  NumberFormat format = {};
  std::string json_name = {};  // empty: the name; for an interval: "interval"
  std::string heading = {};    // for people; empty: the name
  std::string group = {};      // JSON object that holds the value; empty: the row itself
  bool is_key = false;         // identifies the row
  bool is_symbol = false;      // the heading is a mathematical symbol

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

  // "NAME_lower,NAME_upper" in CSV, "NAME_interval" in JSON.
  static Column Bounds(const std::string& name) {
    return {.name = name + "_lower," + name + "_upper",
            .type = ColumnType::kInterval,
            .json_name = name + "_interval"};
  }

  const std::string& Heading() const { return heading.empty() ? name : heading; }
};

struct Table {
  std::vector<Column> columns;
  std::vector<std::vector<Value>> rows = {};  // each row has a value per column

  void AddColumns(const std::vector<Column>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
  }
};

// A column and the function that computes its value from an item.
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

// A key column for each factor with its level; in JSON they are in the object `levels`. levels_of(item)
// returns a level for each factor.
template <typename Item, typename LevelsOf>
std::vector<ColumnOf<Item>> LevelColumns(const std::vector<std::string>& factors, LevelsOf levels_of) {
  std::vector<ColumnOf<Item>> columns;
  for (size_t f = 0; f < factors.size(); ++f) {
    columns.push_back({{.name = factors[f], .group = "levels", .is_key = true},
                       [f, levels_of](const Item& item) { return levels_of(item).at(f); }});
  }
  return columns;
}
// For items with the member `levels`.
template <typename Item>
std::vector<ColumnOf<Item>> LevelColumns(const std::vector<std::string>& factors) {
  return LevelColumns<Item>(
      factors, [](const Item& item) -> const auto& { return item.levels; });
}

// Adds a column with the interval, Column::Bounds, after each column of estimates.
Table WithIntervalColumns(const Table& table);

}  // namespace rcme
