#include "stats/tilted_binomial.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <cmath>

namespace rcme {
namespace {

// k log(to / from), with 0 log 0 = 0.
double LogPower(int k, double from, double to) {
  if (k == 0) return 0.0;
  return k * std::log1p((to - from) / from);  // more accurate than log(to / from) if the two are close
}

// log(Binom(k; n, to) / Binom(k; n, from)); k must be possible under `from`.
double LogLikelihoodRatio(int k, int n, double from, double to) {
  return LogPower(k, from, to) + LogPower(n - k, 1.0 - from, 1.0 - to);
}

// The point between `peak` and `end` where the likelihood has fallen to exp(-45) = 3e-20 of its value at the
// peak, or `end` if that is nearer.
double EndOfSupport(int k, int n, double peak, double end) {
  constexpr double kNegligible = -45.0;
  if (LogLikelihoodRatio(k, n, peak, end) >= kNegligible) return end;
  double inside = peak, outside = end;
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (inside + outside);
    (LogLikelihoodRatio(k, n, peak, middle) >= kNegligible ? inside : outside) = middle;
  }
  return outside;
}

// int Binom(k; n, u) / Binom(k; n, peak) du from the peak to one side. The integrand falls smoothly, its
// shape between a bell (exp(-45) at 9.5 standard deviations) and an exponential: eight panels of 15 nodes are
// exact to rounding.
double IntegralBeside(int k, int n, double peak, double end) {
  constexpr int kPanels = 8;
  const double reach = EndOfSupport(k, n, peak, end) - peak, panel = reach / kPanels;
  double sum = 0.0;
  for (int i = 0; i < kPanels; ++i) {
    sum += boost::math::quadrature::gauss<double, 15>::integrate(
        [&](double x) { return std::exp(LogLikelihoodRatio(k, n, peak, peak + (i + x) * panel)); }, 0.0, 1.0);
  }
  return sum * std::abs(panel);
}

}  // namespace

// The closed form loses all digits if p is close to q (cancellation) or if k is far from both (underflow).
// Instead the likelihood relative to its peak between p and q is integrated, which is at most 1 and neither
// cancels nor underflows.
double TiltedBinomialWeight(int k, int n, double p, double q) {
  if (p == q) return 1.0;
  if ((p == 0.0 && k > 0) || (p == 1.0 && k < n)) return 0.0;
  const auto [low, high] = std::minmax(p, q);
  const double peak = std::clamp(static_cast<double>(k) / n, low, high);
  const double mean = (IntegralBeside(k, n, peak, low) + IntegralBeside(k, n, peak, high)) / (high - low);
  return std::exp(LogLikelihoodRatio(k, n, peak, p)) / mean;
}

}  // namespace rcme
