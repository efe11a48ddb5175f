// Results of a function of few small arguments that is asked for the same again and again, as the intervals
// of thousands of conditions with equally many trials are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

namespace rcme {

// The last result of each of 1,024 places that arguments fall into: memory does not grow. One thread's own.
template <typename Arguments, typename Result>
class Remembered {
 public:
  template <typename Compute>  // Result(): called where the arguments are not those of the place
  const Result& Get(const Arguments& arguments, std::uint64_t place, Compute compute) {
    std::optional<std::pair<Arguments, Result>>& known = places_[place % places_.size()];
    if (!known || known->first != arguments) known.emplace(arguments, compute());
    return known->second;
  }

 private:
  std::array<std::optional<std::pair<Arguments, Result>>, 1024> places_;
};

}  // namespace rcme
