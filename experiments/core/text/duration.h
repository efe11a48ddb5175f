#pragma once

#include <optional>
#include <string>

namespace rcme {

// Parses "55m", "1h30m", "90s" or "1.5h" to seconds, up to 1000 days. Returns nothing for any other text and
// for a duration of zero.
std::optional<double> ParseDuration(const std::string& text);

// Returns what is wrong with the text and what is allowed; an empty text if ParseDuration accepts it. Options
// take it as their check.
std::string ExplainDuration(const std::string& text);

}  // namespace rcme
