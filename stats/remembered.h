// A cache of a function with few small arguments that is often called with the same ones, such as the
// intervals of thousands of conditions with equal numbers of trials.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace rcme {

// Keeps the last result of each of 1,024 slots, so memory is constant. Not thread-safe: use one per thread.
template <typename Arguments, typename Result>
class Remembered {
 public:
  template <typename Compute>  // Result(): called if the slot has other arguments
  const Result& Get(const Arguments& arguments, std::uint64_t place, Compute compute) {
    std::optional<std::pair<Arguments, Result>>& known = places_[place % places_.size()];
    if (!known || known->first != arguments) known.emplace(arguments, compute());
    return known->second;
  }

 private:
  std::array<std::optional<std::pair<Arguments, Result>>, 1024> places_;
};

}  // namespace rcme
