#include "stats/measured_quantile.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "stats/constants.h"
#include "stats/remembered.h"

namespace rcme {

namespace {

RankInterval ComputeQuantileRanks(std::int64_t n, double p, double confidence) {
  // The number of values <= the quantile is B ~ Binomial(n, p). The r-th smallest lies above it if B < r:
  // lower is the largest r with P(B < r) <= tail, upper the least with P(B >= r) <= tail.
  using boost::math::policies::discrete_quantile;
  using boost::math::policies::integer_round_up;
  using Policy = boost::math::policies::policy<discrete_quantile<integer_round_up>>;
  const boost::math::binomial_distribution<double, Policy> law(static_cast<double>(n), p);
  const double tail = 0.5 * (1.0 - confidence);
  return {static_cast<std::int64_t>(quantile(law, tail)),
          static_cast<std::int64_t>(quantile(complement(law, tail))) + 1};
}

}  // namespace

RankInterval QuantileRanks(std::int64_t n, double p, double confidence) {
  thread_local Remembered<std::tuple<std::int64_t, double, double>, RankInterval> remembered;
  return remembered.Get({n, p, confidence}, static_cast<std::uint64_t>(n),
                        [&] { return ComputeQuantileRanks(n, p, confidence); });
}

MeasuredQuantile MeasureQuantile(std::vector<double> values, double p, double confidence) {
  if (values.empty()) throw std::invalid_argument("quantile: no values");
  if (!(p > 0.0 && p < 1.0)) throw std::invalid_argument("quantile: p must be in (0, 1)");
  if (!(confidence > 0.0 && confidence < 1.0))
    throw std::invalid_argument("quantile: confidence must be in (0, 1)");
  for (const double x : values) {
    if (std::isnan(x)) throw std::invalid_argument("quantile: a value is NaN");
  }
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  const auto ranked = [&](double rank) { return values[static_cast<size_t>(std::clamp(rank, 1.0, n)) - 1]; };

  const double spread = std::sqrt(n * p * (1.0 - p));
  MeasuredQuantile measured;
  measured.value = ranked(std::ceil(n * p));
  measured.standard_error = 0.5 * (ranked(std::ceil(n * p + spread)) - ranked(std::floor(n * p - spread)));
  const auto [lower, upper] = QuantileRanks(static_cast<std::int64_t>(values.size()), p, confidence);
  measured.interval = {
      lower < 1 ? -kInfinity : ranked(static_cast<double>(lower)),
      upper > static_cast<std::int64_t>(values.size()) ? kInfinity : ranked(static_cast<double>(upper))};
  return measured;
}

}  // namespace rcme
