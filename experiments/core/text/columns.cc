#include "experiments/core/text/columns.h"

#include <fmt/format.h>

#include <algorithm>

namespace rcme {

std::string FormatColumns(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const std::vector<std::string>& row : rows) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string text;
  for (size_t r = 0; r < rows.size(); ++r) {
    std::string line;
    for (size_t c = 0; c < rows[r].size(); ++c) line += fmt::format("{:<{}}  ", rows[r][c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
    if (r > 0) continue;
    for (const size_t width : widths) text += std::string(width, '-') + "  ";
    text += "\n";
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
