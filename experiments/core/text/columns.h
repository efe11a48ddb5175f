#pragma once

#include <string>
#include <vector>

namespace rcme {

// Rows of text as columns padded to equal width, the first row underlined.
std::string FormatColumns(const std::vector<std::vector<std::string>>& rows);

// The same as a table of Markdown; what would end a cell or begin a tag is escaped.
std::string FormatMarkdown(const std::vector<std::vector<std::string>>& rows);

}  // namespace rcme
