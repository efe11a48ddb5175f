#include "stats/condition_bootstrap.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/moments.h"

namespace rcme {
namespace {

void DrawTimes(RandomStream& rng, std::vector<int>* times) {
  std::ranges::fill(*times, 0);
  const auto m = static_cast<std::uint32_t>(times->size());
  for (std::uint32_t i = 0; i < m; ++i) ++(*times)[rng.IntegerBelow(m)];
}

}  // namespace

BootstrapEstimate BootstrapOverConditions(std::size_t num_conditions, const ConditionStatistic& statistic,
                                          const BootstrapOptions& options, RandomStream& rng) {
  if (num_conditions == 0 || options.num_samples < 2)
    throw std::invalid_argument("bootstrap: at least one condition and two samples are needed");
  std::vector<int> times(num_conditions, 1);
  BootstrapEstimate estimate{statistic(times), kNaN, kNaN, options.range};
  if (num_conditions < 2) return estimate;
  Moments samples;
  for (int sample = 0; sample < options.num_samples; ++sample) {
    DrawTimes(rng, &times);
    const double value = statistic(times);
    if (!std::isnan(value)) samples.Add(value);
  }
  const double m = static_cast<double>(num_conditions);
  estimate.bias = samples.mean() - estimate.value;
  estimate.standard_error = std::sqrt(samples.variance() * m / (m - 1.0));
  if (std::isnan(estimate.standard_error) || std::isnan(estimate.value)) return estimate;
  const double half = StudentQuantile(m - 1.0, 0.5 * (1.0 + options.confidence)) * estimate.standard_error;
  const double by_chance = options.chance_bias == ChanceBias::kUpwards
                               ? (1.0 + std::numbers::sqrt2) * std::max(0.0, estimate.bias)
                               : 0.0;
  estimate.interval = {std::max(options.range.lower, estimate.value - by_chance - half),
                       std::min(options.range.upper, estimate.value + half)};
  return estimate;
}

}  // namespace rcme
