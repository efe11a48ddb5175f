#include "stats/beta_binomial.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace rcme {

double BetaBinomialCdf(std::int64_t successes, std::int64_t n, double a, double b) {
  if (!(a > 0.0) || !(b > 0.0) || n < 0)
    throw std::invalid_argument("beta-binomial: a and b have to be above 0, and n at least 0");
  if (successes >= n) return 1.0;
  // P(X = 0) = B(a, b + n) / B(a, b), and the ratio of neighbours; in logarithms, as the first may be tiny.
  const auto m = static_cast<double>(n);
  double log_p = std::lgamma(b + m) + std::lgamma(a + b) - std::lgamma(b) - std::lgamma(a + b + m);
  double sum = 0.0;
  for (std::int64_t x = 0; x <= successes; ++x) {
    sum += std::exp(log_p);
    const auto k = static_cast<double>(x);
    log_p += std::log((m - k) * (a + k) / ((k + 1.0) * (b + m - k - 1.0)));
  }
  return std::min(sum, 1.0);
}

}  // namespace rcme
