#include "simulator/scenes/shares.h"

#include <fmt/format.h>

#include <algorithm>

#include "parameters/input_error.h"

namespace rcme {

double RestOfShares(const NamedShare& first, const NamedShare& second) {
  const double rest = 1.0 - first.share - second.share;
  if (rest < -1e-9) {
    throw InputError(fmt::format("{}: {} is not allowed; with {} = {} give at most {}", first.key,
                                 first.share, second.key, second.share, 1.0 - second.share));
  }
  return std::max(rest, 0.0);
}

}  // namespace rcme
