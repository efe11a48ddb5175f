#pragma once

#include <string>
#include <vector>

namespace rcme {

inline constexpr size_t kTextWidth = 80;

// The words of a text in lines of at most `width` columns; a longer word has a line of its own.
std::vector<std::string> BreakLines(const std::string& text, size_t width);

// The same as lines of text, which begin with the blanks that the text begins with.
std::string FormatParagraph(const std::string& text);

// Rows of text as columns padded to equal width, the headings of the first row underlined.
std::string FormatColumns(const std::vector<std::vector<std::string>>& rows);

// The same as a table of Markdown; what would end a cell or begin a tag is escaped.
std::string FormatMarkdown(const std::vector<std::vector<std::string>>& rows);

}  // namespace rcme
