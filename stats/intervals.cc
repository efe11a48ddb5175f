#include "stats/intervals.h"

#include <boost/math/distributions/binomial.hpp>
#include <tuple>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/remembered.h"

namespace rcme {
namespace {

Interval ClopperPearson(std::int64_t successes, std::int64_t n, double confidence) {
  using Binomial = boost::math::binomial_distribution<>;
  const double tail = 0.5 * (1.0 - confidence);
  const double trials = static_cast<double>(n), k = static_cast<double>(successes);
  return {successes == 0 ? 0.0 : Binomial::find_lower_bound_on_p(trials, k, tail),
          successes == n ? 1.0 : Binomial::find_upper_bound_on_p(trials, k, tail)};
}

}  // namespace

Interval ExactBinomialInterval(std::int64_t successes, std::int64_t n, double confidence) {
  if (n <= 0) return {0.0, 1.0};
  thread_local Remembered<std::tuple<std::int64_t, std::int64_t, double>, Interval> remembered;
  return remembered.Get({successes, n, confidence}, static_cast<std::uint64_t>(31 * n + successes),
                        [&] { return ClopperPearson(successes, n, confidence); });
}

Interval StudentInterval(const Moments& moments, double confidence) {
  if (moments.n() < 2) return {-kInfinity, kInfinity};
  const double quantile = StudentQuantile(static_cast<int>(moments.n() - 1), 0.5 * (1.0 + confidence));
  const double half_width = quantile * moments.standard_error();
  return {moments.mean() - half_width, moments.mean() + half_width};
}

}  // namespace rcme
