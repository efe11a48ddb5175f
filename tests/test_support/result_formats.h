// What --format prints: the rows of CSV and of JSON are the same.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/core/text/field_text.h"
#include "parameters/parameter.h"
#include "tests/test_support/run_program.h"

namespace rcme {

inline constexpr double kEightDigits = 1e-6;

// Whether a field of CSV is this value of JSON, a number within the relative tolerance. Null: not known or
// infinite.
inline bool IsSameField(const std::string& field, const nlohmann::json& value, double tolerance) {
  double number = 0.0;
  if (value.is_null())
    return field.empty() || (ParseReal(field, &number) && std::isinf(number)) || field == "inf";
  if (value.is_boolean()) return field == (value.get<bool>() ? "yes" : "no");
  if (value.is_string()) return field == value.get<std::string>();
  const double x = value.get<double>();
  return ParseReal(field, &number) && std::abs(number - x) <= tolerance * std::abs(x);
}

// The values of a row by the names that their columns have in CSV.
inline std::vector<std::pair<std::string, nlohmann::json>> ListFields(const nlohmann::json& row) {
  std::vector<std::pair<std::string, nlohmann::json>> fields;
  for (const auto& [key, value] : row.items()) {
    const std::string suffix = "interval";
    if (value.is_array() && value.size() == 2 && key.ends_with(suffix)) {
      const std::string begin = key.substr(0, key.size() - suffix.size());
      fields.emplace_back(begin + "lower", value[0]);
      fields.emplace_back(begin + "upper", value[1]);
    } else if (key == "levels" && value.is_object()) {
      for (const auto& [factor, level] : value.items()) fields.emplace_back(factor, level);
    } else if (key == "R" && value.is_array()) {  // row by row: R_00, R_01, ...
      for (size_t k = 0; k < value.size(); ++k)
        fields.emplace_back("R_" + std::to_string(k / 3) + std::to_string(k % 3), value[k]);
    } else if (key == "t" && value.is_array()) {
      for (size_t k = 0; k < value.size(); ++k) fields.emplace_back("t_" + std::to_string(k), value[k]);
    } else if (value.is_primitive()) {
      fields.emplace_back(key, value);
    }
  }
  return fields;
}

// Every value of a row of JSON that has a column in CSV is there too; two of them at least, and in some row
// half of the columns.
inline void ExpectSameRows(const std::string& csv, const nlohmann::json& rows,
                           double tolerance = kEightDigits) {
  std::vector<std::vector<std::string>> lines;
  std::istringstream stream(csv);
  for (std::string line; std::getline(stream, line);) lines.push_back(CsvFields(line));
  ASSERT_FALSE(lines.empty());
  ASSERT_EQ(lines.size() - 1, rows.size()) << csv;
  size_t most_compared = 0;
  for (size_t r = 0; r < rows.size(); ++r) {
    size_t num_compared = 0;
    for (const auto& [name, value] : ListFields(rows[r])) {
      const auto column = std::ranges::find(lines[0], name);
      if (column == lines[0].end() || name == "seconds") continue;
      const std::string& field = lines[r + 1].at(static_cast<size_t>(column - lines[0].begin()));
      EXPECT_TRUE(IsSameField(field, value, tolerance)) << name << ": " << field << " is not " << value;
      ++num_compared;
    }
    EXPECT_GE(num_compared, 2u) << rows[r];
    most_compared = std::max(most_compared, num_compared);
  }
  if (!rows.empty()) {
    EXPECT_GE(2 * most_compared, lines[0].size()) << csv;
  }
}

// Runs the program with these arguments and --format csv, json, latex and markdown: standard output is one
// table, or one document whose array `key` has the rows of the table.
inline void ExpectFormatsAgree(const std::vector<std::string>& arguments, int exit_code = 0,
                               const std::string& key = "rows", double tolerance = kEightDigits) {
  const auto run = [&](const std::string& format) {
    std::vector<std::string> with_format = arguments;
    with_format.push_back("--format=" + format);
    const ProgramResult result = RunRcme(with_format);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    return result.out;
  };
  const std::string json_text = run("json");
  const nlohmann::json json = nlohmann::json::parse(json_text, nullptr, false);
  ASSERT_FALSE(json.is_discarded()) << json_text;
  EXPECT_EQ(json.at("format").get<std::string>().substr(0, 5), "rcme ");
  ASSERT_TRUE(json.contains(key)) << json_text;
  ExpectSameRows(run("csv"), json.at(key), tolerance);
}

}  // namespace rcme
