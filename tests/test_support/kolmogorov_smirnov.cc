#include "tests/test_support/kolmogorov_smirnov.h"

#include <algorithm>
#include <cmath>

namespace rcme {
namespace {

// P(K > x) of Kolmogorov's limit law, 2 sum (-1)^(k-1) exp(-2 k^2 x^2).
double KolmogorovTail(double x) {
  if (x < 0.2) return 1.0;  // 1 - 1e-12
  double tail = 0.0, sign = 1.0;
  for (int k = 1; k <= 100; ++k, sign = -sign) tail += 2.0 * sign * std::exp(-2.0 * k * k * x * x);
  return std::clamp(tail, 0.0, 1.0);
}

}  // namespace

KolmogorovSmirnov TestKolmogorovSmirnov(std::vector<double> sample,
                                        const std::function<double(double)>& cdf) {
  std::sort(sample.begin(), sample.end());
  const double n = static_cast<double>(sample.size());
  KolmogorovSmirnov test;
  for (size_t i = 0; i < sample.size(); ++i) {
    const double F = cdf(sample[i]);
    const double below = static_cast<double>(i) / n, above = static_cast<double>(i + 1) / n;
    test.statistic = std::max({test.statistic, F - below, above - F});
  }
  const double root = std::sqrt(n);
  test.p_value = KolmogorovTail((root + 0.12 + 0.11 / root) * test.statistic);
  return test;
}

}  // namespace rcme
