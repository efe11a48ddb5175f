#pragma once

#include <string>
#include <vector>

namespace rcme {

inline constexpr size_t kTextWidth = 80;

// Breaks a text into lines of at most `width` columns. A word that is longer gets a line of its own.
std::vector<std::string> BreakLines(const std::string& text, size_t width);

// Breaks a text into lines of kTextWidth; each line is indented by the leading blanks of the text.
std::string FormatParagraph(const std::string& text);

// Formats rows as columns padded to equal width; the first row is the heading and is underlined.
std::string FormatColumns(const std::vector<std::vector<std::string>>& rows);

// Formats rows as columns in lines of kTextWidth: the last column is broken into lines below itself. Where
// that would leave it too narrow, what does not fit stands below its row, with its heading if it is not the
// last column.
std::string FormatNarrowColumns(const std::vector<std::vector<std::string>>& rows);

// Formats rows as a Markdown table; characters that would end a cell or begin a tag are escaped.
std::string FormatMarkdown(const std::vector<std::vector<std::string>>& rows);

}  // namespace rcme
