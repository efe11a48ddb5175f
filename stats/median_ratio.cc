#include "stats/median_ratio.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stats/order_statistic.h"

namespace rcme {
namespace {

double RatioIn(std::span<const UnitValues* const> units) {
  std::vector<double> observed, null;
  for (const UnitValues* unit : units) {
    observed.insert(observed.end(), unit->observed.begin(), unit->observed.end());
    null.insert(null.end(), unit->null.begin(), unit->null.end());
  }
  return ComputeMedian(std::move(observed)) / ComputeMedian(std::move(null));
}

}  // namespace

double ComputeMedian(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const size_t half = values.size() / 2;
  const double middle = ValueOfRank(half, &values);
  if (values.size() % 2 == 1) return middle;
  return 0.5 *
         (middle + *std::max_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(half)));
}

ComparedMedians RatioOfMedians(std::span<const UnitValues> units, double confidence, int num_resamples,
                               RandomStream& rng) {
  std::vector<const UnitValues*> drawn;
  for (const UnitValues& unit : units) drawn.push_back(&unit);
  ComparedMedians compared{RatioIn(drawn), {0.0, std::numeric_limits<double>::infinity()}};
  const auto has_values = [](const UnitValues& unit) { return !unit.observed.empty(); };
  if (std::isnan(compared.value) || std::ranges::count_if(units, has_values) < kLeastUnitsOfRatio)
    return compared;
  std::vector<double> ratios;
  for (int resample = 0; resample < num_resamples; ++resample) {
    for (const UnitValues*& unit : drawn)
      unit = &units[rng.IntegerBelow(static_cast<std::uint32_t>(units.size()))];
    const double ratio = RatioIn(drawn);
    if (!std::isnan(ratio)) ratios.push_back(ratio);
  }
  if (ratios.empty()) return compared;
  std::ranges::sort(ratios);
  const auto quantile = [&](double p) {
    return ratios[static_cast<size_t>(p * static_cast<double>(ratios.size() - 1) + 0.5)];
  };
  compared.interval = {quantile(0.5 * (1.0 - confidence)), quantile(0.5 * (1.0 + confidence))};
  return compared;
}

}  // namespace rcme
