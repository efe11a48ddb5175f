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
  std::vector<size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
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
