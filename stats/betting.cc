#include "stats/betting.h"

#include <algorithm>
#include <cmath>

namespace rcme {
double LogCapital(const std::vector<CountedNumber>& numbers, double m, std::span<const double> stakes,
                  double scale) {
  std::vector<double> log_capital;
  for (const double stake : stakes) {
    double sum = 0.0;
    for (const CountedNumber& number : numbers)
      sum += number.count * std::log1p(scale * stake * (number.x - m));
    log_capital.push_back(sum);
  }
  const double most = *std::max_element(log_capital.begin(), log_capital.end());
  double sum = 0.0;
  for (const double each : log_capital) sum += std::exp(each - most);
  return most + std::log(sum / static_cast<double>(stakes.size()));
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
