#include "stats/consistency.h"

#include <boost/math/distributions/chi_squared.hpp>

namespace rcme {

Interval AneesBounds(std::int64_t n, int degrees_of_freedom, double confidence) {
  if (n <= 0) return {0.0, std::numeric_limits<double>::infinity()};
  const double trials = static_cast<double>(n), tail = 0.5 * (1.0 - confidence);
  const boost::math::chi_squared law(trials * degrees_of_freedom);
  return {quantile(law, tail) / trials, quantile(complement(law, tail)) / trials};
}

}  // namespace rcme
