#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rcme {

// Keys with values as text, such as a `data:` block or the options of an estimator; later entries override
// earlier ones.
using Settings = std::vector<std::pair<std::string, std::string>>;

}  // namespace rcme
