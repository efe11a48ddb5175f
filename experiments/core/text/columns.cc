#include "experiments/core/text/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <sstream>

namespace rcme {
namespace {

void AppendLine(const std::vector<std::string>& cells, const std::vector<size_t>& widths, std::string* text) {
  const size_t begin = text->size();
  for (size_t c = 0; c < cells.size(); ++c)
    fmt::format_to(std::back_inserter(*text), "{:<{}}  ", cells[c], widths[c]);
  const size_t last = text->find_last_not_of(' ');
  text->erase(last == std::string::npos ? begin : std::max(begin, last + 1));
  *text += '\n';
}

bool IsBlank(const std::string& text) { return text.find_first_not_of(' ') == std::string::npos; }

std::vector<size_t> ColumnWidths(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  return widths;
}

// The rows with the last column broken into lines of `width`, each in a row of its own.
std::vector<std::vector<std::string>> BreakLastColumn(const std::vector<std::vector<std::string>>& rows,
                                                      size_t width) {
  std::vector<std::vector<std::string>> broken;
  for (const std::vector<std::string>& row : rows) {
    std::vector<std::string> cells = row;
    for (const std::string& line : BreakLines(row.back(), width)) {
      cells.back() = line;
      broken.push_back(cells);
      std::ranges::fill(cells, "");
    }
  }
  return broken;
}

// The first `num_columns` of each row in a line, the others below it.
std::string FormatStacked(const std::vector<std::vector<std::string>>& rows, size_t num_columns) {
  std::vector<std::vector<std::string>> heads;
  for (const std::vector<std::string>& row : rows)
    heads.emplace_back(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(num_columns));
  std::istringstream lines(FormatColumns(heads));
  std::string text, line;
  for (size_t r = 0; r < rows.size(); ++r) {
    for (int i = r == 0 ? 2 : 1; i > 0 && std::getline(lines, line); --i) text += line + "\n";
    for (size_t c = num_columns; r > 0 && c < rows[r].size(); ++c) {
      if (IsBlank(rows[r][c])) continue;
      const bool is_last = c + 1 == rows[r].size();
      text += FormatParagraph("    " + (is_last ? "" : rows[0][c] + ": ") + rows[r][c]);
    }
  }
  return text;
}

}  // namespace

std::vector<std::string> BreakLines(const std::string& text, size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (!lines.back().empty() && lines.back().size() + 1 + word.size() > width) lines.emplace_back();
    lines.back() += (lines.back().empty() ? "" : " ") + word;
  }
  return lines;
}

std::string FormatParagraph(const std::string& text) {
  const std::string indent(std::min(text.find_first_not_of(' '), text.size()), ' ');
  std::string paragraph;
  for (const std::string& line : BreakLines(text, kTextWidth - indent.size()))
    paragraph += indent + line + "\n";
  return paragraph;
}

std::string FormatColumns(const std::vector<std::vector<std::string>>& rows) {
  const std::vector<size_t> widths = ColumnWidths(rows);
  std::string text;
  for (size_t r = 0; r < rows.size(); ++r) {
    AppendLine(rows[r], widths, &text);
    if (r > 0) continue;
    std::vector<std::string> rules;
    for (size_t c = 0; c < rows[0].size(); ++c) rules.emplace_back(IsBlank(rows[0][c]) ? 0 : widths[c], '-');
    AppendLine(rules, widths, &text);
  }
  return text;
}

std::string FormatNarrowColumns(const std::vector<std::vector<std::string>>& rows) {
  constexpr size_t kGap = 2, kLeastWidth = 20;
  const std::vector<size_t> widths = ColumnWidths(rows);
  std::vector<size_t> begins = {0};  // of each column
  for (const size_t width : widths) begins.push_back(begins.back() + width + kGap);
  const size_t last = widths.size() - 1;
  if (begins[last] + std::min(widths[last], kLeastWidth) <= kTextWidth)
    return FormatColumns(BreakLastColumn(rows, kTextWidth - begins[last]));
  size_t num_columns = 1;
  while (num_columns < last && begins[num_columns + 1] - kGap <= kTextWidth) ++num_columns;
  return FormatStacked(rows, num_columns);
}

std::string FormatMarkdown(const std::vector<std::vector<std::string>>& rows) {
  std::string text;
  for (size_t r = 0; r < rows.size(); ++r) {
    for (const std::string& cell : rows[r]) {
      text += "| ";
      for (const char c : cell) {
        if (c == '|' || c == '<' || c == '*' || c == '\\') text += '\\';
        text += c;
      }
      text += ' ';
    }
    text += "|\n";
    if (r > 0) continue;
    for (size_t c = 0; c < rows[r].size(); ++c) text += "|---";
    text += "|\n";
  }
  return text;
}

}  // namespace rcme
