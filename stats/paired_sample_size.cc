#include "stats/paired_sample_size.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stats/distributions.h"

namespace rcme {

std::int64_t TrialsToTellApart(double first_only, double second_only, double significance, double power) {
  if (!(first_only >= 0.0 && second_only >= 0.0 && first_only + second_only <= 1.0))
    throw std::invalid_argument("TrialsToTellApart: these are no shares of trials");
  const double discordant = first_only + second_only, difference = first_only - second_only;
  const double root = NormalQuantile(1.0 - 0.5 * significance) * std::sqrt(discordant) +
                      NormalQuantile(power) * std::sqrt(discordant - difference * difference);
  const double trials = std::ceil(root * root / (difference * difference));
  constexpr auto kMost = std::numeric_limits<std::int64_t>::max();
  return trials < 9e18 ? static_cast<std::int64_t>(trials) : kMost;
}

}  // namespace rcme
