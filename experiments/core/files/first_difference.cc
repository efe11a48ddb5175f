#include "experiments/core/files/first_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "parameters/text_lines.h"

namespace rcme {

std::string FirstDifference(const std::string& there, const std::string& here) {
  const std::vector<std::string> a = SplitText(there, '\n'), b = SplitText(here, '\n');
  const auto [in_a, in_b] = std::ranges::mismatch(a, b);
  return fmt::format("'{}' there, '{}' here", in_a == a.end() ? "(nothing)" : *in_a,
                     in_b == b.end() ? "(nothing)" : *in_b);
}

}  // namespace rcme
