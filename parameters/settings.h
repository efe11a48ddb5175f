#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rcme {

// Keys with values as text, such as a `data:` block or the options of an estimator; later entries override
// earlier ones.
using Settings = std::vector<std::pair<std::string, std::string>>;

// Returns the last value of `key`; nothing if there is none.
std::optional<std::string> FindSetting(const Settings& settings, const std::string& key);

}  // namespace rcme
