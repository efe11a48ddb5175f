#include "experiments/core/table/render_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>
#include <unordered_map>

#include "experiments/core/text/field_text.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;  // clang 14 does not deduce it

// The symbols of an output format for people.
struct Signs {
  const char *minus, *infinity, *plus_minus, *unknown, *n_begin, *n_end;
  bool is_latex;  // units are in the headings, texts are escaped
};
constexpr Signs kPlainSigns{"-", "inf", "+-", "-", " (n ", ")", false};
constexpr Signs kLatexSigns{"$-$", "$\\infty$", "$\\pm$", "--", " ($n = ", "$)", true};

std::string FormatNumber(double x, const std::string& format, const Signs& signs) {
  if (std::isnan(x)) return signs.unknown;
  if (std::isinf(x)) return fmt::format("{}{}", x < 0.0 ? signs.minus : "", signs.infinity);
  const std::string digits = fmt::format(fmt::runtime("{:" + format + "}"), x);
  return digits.starts_with('-') ? signs.minus + digits.substr(1) : digits;
}

// Empty if an end is not known or both ends are infinite.
std::string FormatInterval(const Interval& interval, double scale, const std::string& format,
                           const Signs& signs) {
  if (std::isnan(interval.lower) || std::isnan(interval.upper)) return "";
  if (std::isinf(interval.lower) && std::isinf(interval.upper)) return "";
  return fmt::format("[{}, {}]", FormatNumber(scale * interval.lower, format, signs),
                     FormatNumber(scale * interval.upper, format, signs));
}

// An estimate with both a standard error and an interval comes from weighted trials. It may be far below a
// hundredth, so it gets significant digits instead of decimals.
std::string FormatEstimate(const Estimate& estimate, const NumberFormat& format, const Signs& signs) {
  if (std::isnan(estimate.value)) return signs.unknown;
  const bool has_error = !std::isnan(estimate.standard_error);
  const bool is_weighted = has_error && !std::isnan(estimate.interval.lower);
  const std::string digits = estimate.decimals < 0 ? format.value : fmt::format(".{}f", estimate.decimals);
  std::string text = FormatNumber(format.scale * estimate.value, is_weighted ? ".3g" : digits, signs);
  if (!signs.is_latex && !format.unit.empty()) text += " " + format.unit;
  if (has_error)
    text += fmt::format(" {} {}", signs.plus_minus,
                        FormatNumber(format.scale * estimate.standard_error, format.spread, signs));
  const std::string interval =
      FormatInterval(estimate.interval, format.scale, is_weighted ? format.spread : digits, signs);
  if (!interval.empty()) text += " " + interval;
  if (estimate.n) text += fmt::format("{}{}{}", signs.n_begin, *estimate.n, signs.n_end);
  return estimate.note.empty() ? text
                               : text + ": " + (signs.is_latex ? LatexText(estimate.note) : estimate.note);
}

std::string FormatValue(const Value& value, const Column& column, const Signs& signs) {
  const NumberFormat& format = column.format;
  return std::visit(
      Overloaded{[](std::monostate) { return std::string(); },
                 [&](const std::string& text) { return signs.is_latex ? LatexText(text) : text; },
                 [](std::int64_t count) { return fmt::format("{}", count); },
                 [](bool flag) { return std::string(flag ? "yes" : "no"); },
                 [&](double x) { return FormatEstimate({.value = x}, format, signs); },
                 [&](const Interval& i) { return FormatInterval(i, format.scale, format.value, signs); },
                 [&](const Estimate& e) { return FormatEstimate(e, format, signs); }},
      value);
}

// Appends a cell; line ends become spaces.
void AppendCell(std::string text, std::vector<std::string>* row) {
  std::ranges::replace_if(
      text, [](char c) { return c == '\n' || c == '\r'; }, ' ');
  row->push_back(std::move(text));
}

Cells FormatCells(const Table& table) {
  Cells cells;
  AppendCells(table, &cells);
  return cells;
}

constexpr size_t kGap = 2;  // between columns

// The width of column c if cells below the heading are broken into lines of at most `most`.
size_t FindWidth(const Cells& cells, size_t c, size_t most = std::string::npos) {
  size_t width = cells[0][c].size();
  for (size_t r = 1; r < cells.size(); ++r) {
    const std::string& cell = cells[r][c];
    if (cell.size() <= most) {
      width = std::max(width, cell.size());
      continue;
    }
    for (const std::string& line : BreakLines(cell, most)) width = std::max(width, line.size());
  }
  return width;
}

// The width of the longest number in column c; of an estimate with a note, what is before the note.
size_t FindNumberWidth(const Cells& cells, size_t c) {
  size_t width = 0;
  for (size_t r = 1; r < cells.size(); ++r) {
    const size_t note = cells[r][c].find(": ");
    width = std::max(width, note == std::string::npos ? cells[r][c].size() : note + 1);
  }
  return width;
}

// The greatest width of a cell by column. A text column gets half of `width`, or less if the keys leave
// less; the only column beside the keys gets all that they leave. So does an estimate, whose note is broken
// and whose number never is.
std::vector<size_t> FindMostWidths(const std::vector<Column>& columns, const Cells& cells, size_t width) {
  const size_t half = width / 2;
  size_t keys_width = 0, num_others = 0;
  for (size_t c = 0; c < columns.size(); ++c) {
    num_others += !columns[c].is_key;
    if (columns[c].is_key) keys_width += std::min(FindWidth(cells, c), half) + kGap;
  }
  const size_t rest =
      std::clamp(width - std::min(keys_width, width), half / 2, num_others == 1 ? width : half);
  std::vector<size_t> most;
  for (size_t c = 0; c < columns.size(); ++c) {
    const bool is_text = columns[c].type == ColumnType::kText;
    if (columns[c].type == ColumnType::kEstimate) {
      most.push_back(std::max(width - std::min(keys_width, width), FindNumberWidth(cells, c)));
    } else {
      most.push_back(!is_text ? std::string::npos : columns[c].is_key ? half : rest);
    }
  }
  return most;
}

// Breaks cells that are too wide: their further lines become rows whose other cells are empty.
Cells BreakCells(Cells cells, const std::vector<size_t>& most) {
  const auto is_whole = [&](const std::vector<std::string>& row) {
    return std::ranges::equal(row, most, [](const std::string& cell, size_t m) { return cell.size() <= m; });
  };
  if (std::all_of(cells.begin() + 1, cells.end(), is_whole)) return cells;
  Cells broken = {std::move(cells[0])};
  for (size_t r = 1; r < cells.size(); ++r) {
    const std::vector<std::string> row = std::move(cells[r]);
    const size_t first = broken.size();
    broken.push_back(row);
    for (size_t c = 0; c < row.size(); ++c) {
      if (row[c].size() <= most[c]) continue;
      const std::vector<std::string> lines = BreakLines(row[c], most[c]);
      broken.resize(std::max(broken.size(), first + lines.size()), std::vector<std::string>(row.size()));
      for (size_t k = 0; k < lines.size(); ++k) broken[first + k][c] = lines[k];
    }
  }
  return broken;
}

// Takes the headings and cells of a block's columns out of `cells`; key columns are copied. Rows without a
// value beside their keys are omitted, except in the first block.
Cells TakeBlock(const std::vector<Column>& columns, const std::vector<size_t>& block, bool is_first,
                Cells* cells) {
  Cells part;
  for (std::vector<std::string>& row : *cells) {
    const bool says_something = std::ranges::any_of(block, [&](size_t c) {
      return !columns[c].is_key && row[c].find_first_not_of(' ') != std::string::npos;
    });
    if (!says_something && !is_first && !part.empty()) continue;
    part.emplace_back();
    part.back().reserve(block.size());
    for (const size_t c : block) part.back().push_back(columns[c].is_key ? row[c] : std::move(row[c]));
  }
  return part;
}

// Pads counts on the left to align them at their last digit.
void AlignCounts(const std::vector<Column>& columns, Cells* cells) {
  for (size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].type != ColumnType::kCount) continue;
    size_t width = 0;
    for (const auto& row : *cells) width = std::max(width, row[c].size());
    for (auto& row : *cells) row[c].insert(0, width - row[c].size(), ' ');
  }
}

// Divides the columns into blocks: each has the keys and as many other columns as fit. most: the greatest
// width of a cell by column.
std::vector<std::vector<size_t>> SplitIntoBlocks(const std::vector<Column>& columns, const Cells& cells,
                                                 const std::vector<size_t>& most, size_t max_width) {
  std::vector<size_t> keys;
  size_t keys_width = 0;
  const auto width_of = [&](size_t c) { return FindWidth(cells, c, most[c]) + kGap; };
  for (size_t c = 0; c < columns.size(); ++c) {
    if (!columns[c].is_key) continue;
    keys.push_back(c);
    keys_width += width_of(c);
  }
  std::vector<std::vector<size_t>> blocks = {keys};
  size_t width = keys_width;
  for (size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].is_key) continue;
    const size_t width_of_column = width_of(c);
    if (width + width_of_column > max_width + kGap && blocks.back().size() > keys.size()) {
      blocks.push_back(keys);
      width = keys_width;
    }
    blocks.back().push_back(c);
    width += width_of_column;
  }
  return blocks;
}

std::string RenderCsvValue(const Value& value, const Column& column) {
  const std::string& format = column.format.file;
  return std::visit(
      Overloaded{
          [&](std::monostate) { return std::string(column.type == ColumnType::kInterval ? "," : ""); },
          [](const std::string& text) { return CsvField(text); },
          [](std::int64_t count) { return fmt::format("{}", count); },
          [](bool flag) { return std::string(flag ? "yes" : "no"); },
          [&](double x) { return CsvNumber(x, format); },
          [&](const Interval& i) { return CsvFinite(i.lower, format) + "," + CsvFinite(i.upper, format); },
          [&](const Estimate& e) { return CsvNumber(e.value, format); }},
      value);
}

// render_field(c): the text of column c.
template <typename RenderField>
void AppendCsvLine(const std::vector<Column>& columns, RenderField render_field, std::string* text) {
  bool is_first = true;
  for (size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].name.empty()) continue;
    if (!is_first) *text += ',';
    is_first = false;
    *text += render_field(c);
  }
  *text += '\n';
}

Json RenderJsonValue(const Value& value) {
  return std::visit(
      Overloaded{[](std::monostate) { return Json(); }, [](const std::string& text) { return Json(text); },
                 [](std::int64_t count) { return Json(count); }, [](bool flag) { return Json(flag); },
                 [](double x) { return JsonNumber(x); }, [](const Interval& i) { return RenderJson(i); },
                 [](const Estimate& e) { return JsonNumber(e.value); }},
      value);
}

std::string JsonName(const Column& column) {
  if (!column.json_name.empty()) return column.json_name;
  return column.type == ColumnType::kInterval ? "interval" : column.name;
}

std::string RenderLatexHeading(const Column& column) {
  const std::string heading = column.is_symbol ? "$" + column.Heading() + "$" : LatexText(column.Heading());
  return column.format.unit.empty() ? heading
                                    : fmt::format("{} ({})", heading, LatexText(column.format.unit));
}

bool HasSameLevels(const Table& table, const std::vector<Value>& row, const std::vector<Value>& before) {
  for (size_t c = 0; c < row.size(); ++c) {
    const auto format = [&](const Value& value) { return FormatValue(value, table.columns[c], kPlainSigns); };
    if (table.columns[c].group == "levels" && format(row[c]) != format(before[c])) return false;
  }
  return true;
}

std::string RenderLatexRow(const Table& table, const std::vector<Value>& row, bool has_levels) {
  std::vector<std::string> cells;
  for (size_t c = 0; c < row.size(); ++c) {
    const Column& column = table.columns[c];
    if (column.group == "levels" && !has_levels) {
      cells.emplace_back();
    } else {
      cells.push_back(FormatValue(row[c], column, kLatexSigns));
    }
  }
  return fmt::format("{} \\\\\n", fmt::join(cells, " & "));
}

// The levels that the first one determines, the last column first, such as those of the draws of a
// population, which are numbered, if the keys together take more than half of `width`.
std::vector<size_t> FindImpliedLevels(const std::vector<Column>& columns, const Cells& cells, size_t width) {
  std::vector<size_t> levels, implied;
  size_t keys_width = 0;
  for (size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].is_key) keys_width += FindWidth(cells, c) + kGap;
    if (columns[c].is_key && columns[c].group == "levels") levels.push_back(c);
  }
  if (keys_width <= width / 2 || levels.empty()) return {};
  for (size_t k = levels.size() - 1; k > 0; --k) {
    std::unordered_map<std::string_view, std::string_view> level_of;  // by that of the first
    const bool is_implied = std::all_of(cells.begin() + 1, cells.end(), [&](const auto& row) {
      return level_of.try_emplace(row[levels[0]], row[levels[k]]).first->second == row[levels[k]];
    });
    if (is_implied && level_of.size() > 1) implied.push_back(levels[k]);
  }
  return implied;
}

}  // namespace

std::string FormatEstimate(const Estimate& estimate, const NumberFormat& format) {
  return FormatEstimate(estimate, format, kPlainSigns);
}

void AppendCells(const Table& rows, Cells* cells) {
  if (cells->empty()) {
    cells->emplace_back();
    for (const Column& column : rows.columns) AppendCell(column.Heading(), &cells->back());
  }
  for (const std::vector<Value>& row : rows.rows) {
    cells->emplace_back();
    cells->back().reserve(row.size());
    for (size_t c = 0; c < row.size(); ++c)
      AppendCell(FormatValue(row[c], rows.columns[c], kPlainSigns), &cells->back());
  }
}

std::string RenderCells(std::vector<Column> columns, Cells cells, size_t width) {
  const std::vector<size_t> implied = FindImpliedLevels(columns, cells, width);
  for (const size_t c : implied) {
    columns.erase(columns.begin() + static_cast<std::ptrdiff_t>(c));
    for (std::vector<std::string>& row : cells) row.erase(row.begin() + static_cast<std::ptrdiff_t>(c));
  }
  AlignCounts(columns, &cells);
  const std::vector<size_t> most = FindMostWidths(columns, cells, width);
  std::string text;
  for (const std::vector<size_t>& block : SplitIntoBlocks(columns, cells, most, width)) {
    std::vector<size_t> most_of_block;
    for (const size_t c : block) most_of_block.push_back(most[c]);
    Cells part = TakeBlock(columns, block, text.empty(), &cells);
    if (part.size() == 1 && cells.size() > 1) continue;
    text += (text.empty() ? "" : "\n") + FormatColumns(BreakCells(std::move(part), most_of_block));
  }
  if (!implied.empty()) text += fmt::format("({} stands for {} more columns)\n", cells[0][0], implied.size());
  return text;
}

std::string RenderText(const Table& table, size_t width) {
  return RenderCells(table.columns, FormatCells(table), width);
}

std::string RenderCsvHeading(const Table& table) {
  std::string text;
  const auto render_field = [&](size_t c) {
    const Column& column = table.columns[c];
    return column.type == ColumnType::kInterval ? column.name : CsvField(column.name);
  };
  AppendCsvLine(table.columns, render_field, &text);
  return text;
}

std::string RenderCsvRows(const Table& table) {
  std::string text;
  for (const std::vector<Value>& row : table.rows) {
    const auto render_field = [&](size_t c) { return RenderCsvValue(row[c], table.columns[c]); };
    AppendCsvLine(table.columns, render_field, &text);
  }
  return text;
}

std::string RenderCsv(const Table& table) { return RenderCsvHeading(table) + RenderCsvRows(table); }

Json RenderJson(const Table& table) {
  Json rows = Json::array();
  for (const std::vector<Value>& row : table.rows) {
    Json object = Json::object();
    for (size_t c = 0; c < row.size(); ++c) {
      const Column& column = table.columns[c];
      if (column.json_name == kNotInJson || std::holds_alternative<std::monostate>(row[c])) continue;
      (column.group.empty() ? object : object[column.group])[JsonName(column)] = RenderJsonValue(row[c]);
    }
    rows.push_back(std::move(object));
  }
  return rows;
}

Json RenderJson(const Estimate& estimate) {
  Json json = {{"value", JsonNumber(estimate.value)}, {"interval", RenderJson(estimate.interval)}};
  if (estimate.n) json["n"] = *estimate.n;
  return json;
}

Json RenderJson(const Interval& interval) { return {JsonNumber(interval.lower), JsonNumber(interval.upper)}; }

Json RenderJsonBounds(const Estimate& estimate) {
  return {{"value", JsonNumber(estimate.value)},
          {"lower", JsonNumber(estimate.interval.lower)},
          {"upper", JsonNumber(estimate.interval.upper)}};
}

std::string RenderLatex(const Table& table) {
  std::string alignment, body;
  std::vector<std::string> headings;
  for (const Column& column : table.columns) {
    alignment += column.type == ColumnType::kText ? 'l' : 'r';
    headings.push_back(RenderLatexHeading(column));
  }
  for (size_t r = 0; r < table.rows.size(); ++r) {
    const bool begins_group = r == 0 || !HasSameLevels(table, table.rows[r], table.rows[r - 1]);
    if (begins_group && r > 0) body += "\\addlinespace\n";
    body += RenderLatexRow(table, table.rows[r], begins_group);
  }
  return fmt::format(
      "\\begin{{tabular}}{{{}}}\n\\toprule\n{} \\\\\n\\midrule\n{}\\bottomrule\n\\end{{tabular}}\n",
      alignment, fmt::join(headings, " & "), body);
}

std::string RenderMarkdown(const Table& table) { return FormatMarkdown(FormatCells(table)); }

}  // namespace rcme
