#include "stats/betting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stats/betting.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h:
#include "stats/portable_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace rcme::HWY_NAMESPACE {

// sums[k] = sum_i count_i log(1 + stakes[k] (x_i - m)), of eight stakes.
void SumLogsOfEight(const std::vector<CountedNumber>& numbers, double m, const double* HWY_RESTRICT stakes,
                    double* HWY_RESTRICT sums) {
  const hn::CappedTag<double, 8> d;
  const auto one = hn::Set(d, 1.0);
  for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
    const auto stake = hn::LoadU(d, stakes + k);
    auto sum = hn::Zero(d);
    for (const CountedNumber& number : numbers) {
      const auto factor = hn::Add(one, hn::Mul(stake, hn::Set(d, number.x - m)));
      sum = hn::Add(sum, hn::Mul(hn::Set(d, number.count), ComputeLog(d, factor)));
    }
    hn::StoreU(sum, d, sums + k);
  }
}

}  // namespace rcme::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rcme {

HWY_EXPORT(SumLogsOfEight);

namespace {

constexpr size_t kMostStakes = 16;

// log K of every stake, padded with stakes of 0, which leave the capital unchanged.
struct LogCapitals {
  std::array<double, kMostStakes> values;
  std::span<const double> of_stakes;
  double most;

  LogCapitals(const std::vector<CountedNumber>& numbers, double m, std::span<const double> stakes,
              double scale)
      : of_stakes(values.data(), stakes.size()) {
    if (stakes.empty() || stakes.size() > kMostStakes)
      throw std::invalid_argument("betting: number of stakes");
    std::array<double, kMostStakes> scaled{};
    for (size_t k = 0; k < stakes.size(); ++k) scaled[k] = scale * stakes[k];
    for (size_t k = 0; k < stakes.size(); k += 8)
      HWY_DYNAMIC_DISPATCH(SumLogsOfEight)(numbers, m, &scaled[k], &values[k]);
    most = *std::ranges::max_element(of_stakes);
  }
  LogCapitals(const LogCapitals&) = delete;

  double LogOfMean() const {
    double sum = 0.0;
    for (const double each : of_stakes) sum += std::exp(each - most);
    return most + std::log(sum / static_cast<double>(of_stakes.size()));
  }
};

}  // namespace

double LogCapital(const std::vector<CountedNumber>& numbers, double m, std::span<const double> stakes,
                  double scale) {
  return LogCapitals(numbers, m, stakes, scale).LogOfMean();
}

bool IsCapitalAtLeast(double log_capital, const std::vector<CountedNumber>& numbers, double m,
                      std::span<const double> stakes, double scale) {
  const LogCapitals capitals(numbers, m, stakes, scale);
  // Cheap test first: the mean is at most the greatest.
  return capitals.most >= log_capital && capitals.LogOfMean() >= log_capital;
}

double GreatestExcluded(double mean, double distance, const std::function<bool(double)>& is_excluded) {
  const double tolerance = 1e-3 * distance;
  double inside = mean, outside = mean - distance;
  while (outside > 0.0 && !is_excluded(outside)) inside = outside, outside -= distance;
  if (outside <= 0.0) {
    outside = 0.0;
    if (!is_excluded(0.0)) return 0.0;
  }
  while (inside - outside > tolerance) {
    const double middle = 0.5 * (inside + outside);
    (is_excluded(middle) ? outside : inside) = middle;
  }
  return outside;
}

}  // namespace rcme
#endif  // HWY_ONCE
