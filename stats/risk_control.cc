#include "stats/risk_control.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace rcme {

double ExcessPValue(const ErrorCount& count, double at_most) {
  if (count.n <= 0) return 1.0;
  const boost::math::binomial law(static_cast<double>(count.n), at_most);
  return cdf(law, static_cast<double>(count.errors));
}

double MeanLossPValue(double mean, std::int64_t n, double at_most) {
  if (n == 0 || !(mean < at_most)) return 1.0;
  const auto count = static_cast<double>(n);
  const double divergence = (mean > 0.0 ? mean * std::log(mean / at_most) : 0.0) +
                            (1.0 - mean) * std::log((1.0 - mean) / (1.0 - at_most));
  const auto errors = static_cast<std::int64_t>(std::ceil(count * mean - 1e-9));
  return std::min({1.0, std::exp(-count * divergence),
                   std::numbers::e * ExcessPValue({std::max<std::int64_t>(errors, 0), n}, at_most)});
}

std::int64_t LargestCertifyingCount(std::int64_t n, double at_most, double delta) {
  std::int64_t certifying = -1, not_certifying = n;  // P(Binomial(n, .) <= n) = 1
  if (n <= 0) return -1;
  while (not_certifying - certifying > 1) {
    const std::int64_t middle = certifying + (not_certifying - certifying) / 2;
    (ExcessPValue({middle, n}, at_most) <= delta ? certifying : not_certifying) = middle;
  }
  return certifying;
}

std::int64_t FewestCertifyingTrials(double at_most, double delta) {
  return static_cast<std::int64_t>(std::ceil(std::log(delta) / std::log1p(-at_most)));
}

std::int64_t TrialsToCertify(double rate, double at_most, double delta, double power) {
  if (!(rate < at_most)) throw std::invalid_argument("TrialsToCertify: rate < at_most is needed");
  const auto has_power = [&](std::int64_t n) {
    const std::int64_t k = LargestCertifyingCount(n, at_most, delta);
    return k >= 0 && ExcessPValue({k, n}, rate) >= power;
  };
  constexpr std::int64_t kBeyondReach = std::int64_t{1} << 50;  // the rate hardly differs from the limit
  std::int64_t few = 0, enough = FewestCertifyingTrials(at_most, delta);
  while (!has_power(enough)) {
    if (enough > kBeyondReach) return enough;
    few = enough;
    enough *= 2;
  }
  while (enough - few > 1) {  // power is a sawtooth in n: the result is within one tooth of the smallest
    const std::int64_t middle = few + (enough - few) / 2;
    (has_power(middle) ? enough : few) = middle;
  }
  return enough;
}

std::size_t CountCertified(const std::vector<double>& p_values, double delta) {
  const auto first_not = std::ranges::find_if(p_values, [&](double p) { return !(p <= delta); });
  return static_cast<std::size_t>(first_not - p_values.begin());
}

}  // namespace rcme
