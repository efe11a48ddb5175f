// Names of the values of an enumeration.
#pragma once

#include <cstddef>

namespace rcme {

// Returns the name of a value. `names` has one for each value, in the order of the enumeration.
template <typename Enum, size_t num_names>
constexpr const char* PickName(Enum value, const char* const (&names)[num_names]) {
  const auto place = static_cast<size_t>(value);
  return place < num_names ? names[place] : "";
}

}  // namespace rcme
