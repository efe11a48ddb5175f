#include "tests/test_support/goodness_of_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rcme {
namespace {

// P(K > x) of Kolmogorov's limit law, 2 sum (-1)^(k-1) exp(-2 k^2 x^2).
double KolmogorovTail(double x) {
  if (x < 0.2) return 1.0;  // 1 - 1e-12
  double tail = 0.0, sign = 1.0;
  for (int k = 1; k <= 100; ++k, sign = -sign) tail += 2.0 * sign * std::exp(-2.0 * k * k * x * x);
  return std::clamp(tail, 0.0, 1.0);
}

// int_0^inf exp(z / (8 (w^2 + 1)) - b w^2) dw by the trapezium rule, which converges like exp(-2 pi / step):
// the integrand is even and analytic up to its poles at +-i.
double AndersonDarlingIntegral(double z, double b) {
  const double step = std::min(0.15, 0.5 / std::sqrt(b));
  double sum = 0.5 * std::exp(z / 8.0);
  for (int i = 1;; ++i) {
    const double w = i * step;
    if (b * w * w > 40.0) return sum * step;
    sum += std::exp(z / (8.0 * (w * w + 1.0)) - b * w * w);
  }
}

// P(A^2 <= z) in the limit of large n (Anderson & Darling 1952, eq. 4.35):
//   sqrt(2 pi) / z  sum_j binom(-1/2, j) (4 j + 1) exp(-b_j) int_0^inf exp(z / (8 (w^2 + 1)) - b_j w^2) dw,
// b_j = (4 j + 1)^2 pi^2 / (8 z).
double AndersonDarlingLimitCdf(double z) {
  if (z < 0.02) return 0.0;  // below 1e-25
  if (z > 40.0) return 1.0;  // above 1 - 1e-17
  double sum = 0.0, binomial = 1.0;
  for (int j = 0; j < 100; ++j) {
    const double m = 4.0 * j + 1.0;
    const double b = m * m * std::numbers::pi * std::numbers::pi / (8.0 * z);
    if (b > 60.0 && j > 0) break;
    sum += binomial * m * std::exp(-b) * AndersonDarlingIntegral(z, b);
    binomial *= -(j + 0.5) / (j + 1.0);
  }
  return std::clamp(std::sqrt(2.0 * std::numbers::pi) / z * sum, 0.0, 1.0);
}

// What to add to the limit law's x = P(A^2 <= z) for n numbers (Marsaglia & Marsaglia 2004, section 3).
double AndersonDarlingCorrection(double x, double n) {
  if (x > 0.8) {
    return (-130.2137 + (745.2337 - (1705.091 - (1950.646 - (1116.360 - 255.7844 * x) * x) * x) * x) * x) / n;
  }
  const double crossover = 0.01265 + 0.1757 / n;
  if (x < crossover) {
    const double u = x / crossover;
    return std::sqrt(u) * (1.0 - u) * (49.0 * u - 102.0) * (0.0037 / (n * n) + 0.00078 / n + 0.00006) / n;
  }
  const double u = (x - crossover) / (0.8 - crossover);
  return (-0.00022633 + (6.54034 - (14.6538 - (14.458 - (8.259 - 1.91864 * u) * u) * u) * u) * u) *
         (0.04213 + 0.01365 / n) / n;
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

double AndersonDarlingTail(double statistic, std::int64_t n) {
  if (!(statistic < std::numeric_limits<double>::infinity())) return 0.0;
  const double x = AndersonDarlingLimitCdf(statistic);
  return std::clamp(1.0 - x - AndersonDarlingCorrection(x, static_cast<double>(n)), 0.0, 1.0);
}

AndersonDarling TestAndersonDarling(const std::vector<double>& sample,
                                    const std::function<double(double)>& cdf) {
  if (sample.empty()) return {};
  std::vector<double> F;
  for (const double x : sample) {
    F.push_back(cdf(x));
    if (!(F.back() > 0.0 && F.back() < 1.0)) return {std::numeric_limits<double>::infinity(), 0.0};
  }
  std::sort(F.begin(), F.end());
  const size_t n = F.size();
  double sum = 0.0;
  for (size_t i = 0; i < n; ++i) {
    sum += (2.0 * static_cast<double>(i) + 1.0) * (std::log(F[i]) + std::log1p(-F[n - 1 - i]));
  }
  const double statistic = -static_cast<double>(n) - sum / static_cast<double>(n);
  return {statistic, AndersonDarlingTail(statistic, static_cast<std::int64_t>(n))};
}

}  // namespace rcme
