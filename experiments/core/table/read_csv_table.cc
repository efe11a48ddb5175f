#include "experiments/core/table/read_csv_table.h"

#include <limits>

#include "experiments/core/text/field_text.h"
#include "parameters/parameter.h"
#include "parameters/text_lines.h"

namespace rcme {
namespace {

using Fields = std::vector<std::vector<std::string>>;  // of each line

ColumnType FindType(const Fields& lines, size_t c) {
  bool are_whole = true, are_numbers = true;
  for (size_t r = 1; r < lines.size(); ++r) {
    const std::string& field = lines[r].at(c);
    long long whole = 0;
    double number = 0.0;
    are_whole = are_whole && ParseInteger(field, &whole);
    are_numbers = are_numbers && (field.empty() || ParseReal(field, &number));
  }
  return are_whole ? ColumnType::kCount : are_numbers ? ColumnType::kNumber : ColumnType::kText;
}

Value ParseValue(const std::string& field, ColumnType type) {
  if (type == ColumnType::kText) return field;
  if (type == ColumnType::kCount) {
    long long whole = 0;
    ParseInteger(field, &whole);
    return std::int64_t{whole};
  }
  double number = std::numeric_limits<double>::quiet_NaN();
  ParseReal(field, &number);
  return number;
}

}  // namespace

Table ReadCsvTable(const std::string& text) {
  const NumberFormat all_digits{1.0, "", ".3g", ".2g", ""};
  Fields lines;
  for (const std::string& line : SplitText(text, '\n')) lines.push_back(CsvFields(line));
  Table table;
  if (lines.empty()) return table;
  for (size_t c = 0; c < lines[0].size(); ++c)
    table.columns.push_back({lines[0][c], FindType(lines, c), all_digits});
  for (size_t r = 1; r < lines.size(); ++r) {
    table.rows.emplace_back();
    for (size_t c = 0; c < table.columns.size(); ++c)
      table.rows.back().push_back(ParseValue(lines[r].at(c), table.columns[c].type));
  }
  return table;
}

}  // namespace rcme
