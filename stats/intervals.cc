#include "stats/intervals.h"

#include <boost/math/distributions/binomial.hpp>

namespace rcme {

Interval ExactBinomialInterval(std::int64_t successes, std::int64_t n, double confidence) {
  if (n <= 0) return {0.0, 1.0};
  using Binomial = boost::math::binomial_distribution<>;
  const double tail = 0.5 * (1.0 - confidence);
  const double trials = static_cast<double>(n), k = static_cast<double>(successes);
  return {successes == 0 ? 0.0 : Binomial::find_lower_bound_on_p(trials, k, tail),
          successes == n ? 1.0 : Binomial::find_upper_bound_on_p(trials, k, tail)};
}

}  // namespace rcme
