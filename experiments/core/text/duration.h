#pragma once

#include <optional>
#include <string>

namespace rcme {

// "55m", "1h30m", "90s", "1.5h" in seconds, up to 1000 days; nothing for any other text, or for no time at
// all.
std::optional<double> ParseDuration(const std::string& text);

}  // namespace rcme
