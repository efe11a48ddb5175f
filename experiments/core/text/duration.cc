#include "experiments/core/text/duration.h"

#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {

std::optional<double> ParseDuration(const std::string& text) {
  constexpr double kMaxSeconds = 86400.0 * 1000.0;
  double seconds = 0.0;
  for (size_t begin = 0; begin < text.size();) {
    const size_t unit = text.find_first_of("smh", begin);
    double number = 0.0;
    if (unit == std::string::npos || !ParseReal(text.substr(begin, unit - begin), &number) || number < 0.0)
      return std::nullopt;
    seconds += number * (text[unit] == 'h' ? 3600.0 : text[unit] == 'm' ? 60.0 : 1.0);
    begin = unit + 1;
  }
  if (!(seconds > 0.0 && seconds <= kMaxSeconds)) return std::nullopt;
  return seconds;
}

std::string ExplainDuration(const std::string& text) {
  if (ParseDuration(text)) return "";
  const bool lacks_unit = ParseDuration(text + "s").has_value();
  return Quoted(text) + (lacks_unit ? " has no unit at its end" : " is not allowed") +
         "; give a time up to 1000 days in h, m and s, such as 55m, 1h30m or 90s";
}

}  // namespace rcme
