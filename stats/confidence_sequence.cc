#include "stats/confidence_sequence.h"

#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <stdexcept>

namespace rcme {
namespace {

// Boost's lgamma, because the C library's writes a global variable.
double LogBeta(double a, double b) {
  return boost::math::lgamma(a) + boost::math::lgamma(b) - boost::math::lgamma(a + b);
}

// count * log(p), 0 where the count is 0.
double LogPower(double count, double log_p) { return count == 0.0 ? 0.0 : count * log_p; }

// log p^s (1 - p)^f.
double LogLikelihood(double s, double f, double p) {
  return LogPower(s, std::log(p)) + LogPower(f, std::log1p(-p));
}

// Log of the mean of p^s (1 - p)^f over p ~ Beta(a, b).
double LogMixtureLikelihood(double s, double f, const BetaPrior& prior) {
  if (s < 0.0 || f < 0.0) throw std::invalid_argument("confidence sequence: successes outside 0..n");
  if (!(prior.a > 0.0 && prior.b > 0.0))
    throw std::invalid_argument("confidence sequence: prior not positive");
  return LogBeta(prior.a + s, prior.b + f) - LogBeta(prior.a, prior.b);
}

// The p between `inside` and `outside` where `is_inside` changes, to the last bit.
template <typename Predicate>
double Border(double inside, double outside, const Predicate& is_inside) {
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (inside + outside);
    if (middle == inside || middle == outside) break;
    (is_inside(middle) ? inside : outside) = middle;
  }
  return outside;  // errs by one bit towards wider
}

}  // namespace

double LogMixtureLikelihoodRatio(std::int64_t successes, std::int64_t n, double probability,
                                 const BetaPrior& prior) {
  const double s = static_cast<double>(successes), f = static_cast<double>(n - successes);
  return LogMixtureLikelihood(s, f, prior) - LogLikelihood(s, f, probability);
}

Interval ConfidenceSequence(std::int64_t successes, std::int64_t n, double confidence,
                            const BetaPrior& prior) {
  if (n <= 0) return {0.0, 1.0};
  // log M is convex in p, and its minimum at s / n is at most 0: there is one border on each side.
  const double s = static_cast<double>(successes), f = static_cast<double>(n - successes);
  const double least_log_likelihood = LogMixtureLikelihood(s, f, prior) + std::log1p(-confidence);
  const auto is_inside = [&](double p) { return LogLikelihood(s, f, p) > least_log_likelihood; };
  const double rate = s / static_cast<double>(n);
  return {successes == 0 ? 0.0 : Border(rate, 0.0, is_inside),
          successes == n ? 1.0 : Border(rate, 1.0, is_inside)};
}

}  // namespace rcme
