#include "stats/lognormal_mean.h"

#include <cmath>
#include <limits>

#include "stats/distributions.h"

namespace rcme {

Interval LognormalMeanInterval(const Moments& logarithms, double confidence) {
  if (logarithms.n() < 2) return {0.0, std::numeric_limits<double>::infinity()};
  const double n = static_cast<double>(logarithms.n()), v = logarithms.variance();
  const double t = StudentQuantile(static_cast<int>(logarithms.n() - 1), 0.5 + 0.5 * confidence);
  const double half_width = t * std::sqrt(v / n + v * v / (2.0 * (n - 1.0)));
  const double centre = logarithms.mean() + 0.5 * v;
  return {std::exp(centre - half_width), std::exp(centre + half_width)};
}

}  // namespace rcme
