#pragma once

#include <cstdint>

namespace rcme {

// The trials first, ..., end - 1 of a condition.
struct TrialRange {
  std::uint32_t first = 0, end = 0;
};

}  // namespace rcme
