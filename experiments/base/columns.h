#pragma once

#include <string>
#include <vector>

namespace rcme {

// Rows of text as columns padded to equal width, the first row underlined.
std::string FormatColumns(const std::vector<std::vector<std::string>>& rows);

}  // namespace rcme
