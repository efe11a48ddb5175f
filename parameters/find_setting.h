#pragma once

#include <optional>
#include <string>

#include "parameters/settings.h"

namespace rcme {

// Returns the last value of `key`, because later entries override earlier ones; nothing if there is none.
std::optional<std::string> FindSetting(const Settings& settings, const std::string& key);

}  // namespace rcme
