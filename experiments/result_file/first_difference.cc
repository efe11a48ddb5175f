#include "experiments/result_file/first_difference.h"

#include <fmt/format.h>

#include <sstream>

namespace rcme {

std::string FirstDifference(const std::string& there, const std::string& here) {
  std::istringstream a(there), b(here);
  std::string line_a, line_b;
  while (true) {
    const bool has_a = static_cast<bool>(std::getline(a, line_a));
    const bool has_b = static_cast<bool>(std::getline(b, line_b));
    if (!has_a) line_a = "(nothing)";
    if (!has_b) line_b = "(nothing)";
    if (line_a != line_b || (!has_a && !has_b)) return fmt::format("'{}' there, '{}' here", line_a, line_b);
  }
}

}  // namespace rcme
