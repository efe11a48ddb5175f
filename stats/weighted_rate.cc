#include "stats/weighted_rate.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>

#include "stats/constants.h"

namespace rcme {
namespace {

// Quantiles of the gamma law with this mean and variance.
double GammaQuantile(double mean, double variance, double probability) {
  return variance / mean * boost::math::gamma_p_inv(mean * mean / variance, probability);
}

// The ends of the interval of the sum; the upper one after one more event of weight m.
double LowerEnd(const WeightedEvents& events, double tail) {
  if (events.sum_weights == 0.0) return 0.0;
  return GammaQuantile(events.sum_weights, events.sum_squared_weights, tail);
}
double UpperEnd(const WeightedEvents& events, double m, double tail) {
  return GammaQuantile(events.sum_weights + m, events.sum_squared_weights + m * m, 1.0 - tail);
}

}  // namespace

void WeightedEvents::Add(double weight, bool happened) {
  ++num_trials;
  max_weight = std::max(max_weight, weight);
  if (!happened) return;
  sum_weights += weight;
  sum_squared_weights += weight * weight;
  max_event_weight = std::max(max_event_weight, weight);
}

void WeightedEvents::Merge(const WeightedEvents& other) {
  num_trials += other.num_trials;
  max_weight = std::max(max_weight, other.max_weight);
  sum_weights += other.sum_weights;
  sum_squared_weights += other.sum_squared_weights;
  max_event_weight = std::max(max_event_weight, other.max_event_weight);
}

WeightedRate EstimateWeightedRate(const WeightedEvents& events) {
  WeightedRate rate;
  if (events.num_trials == 0) return {0.0, kInfinity, 0.0, {0.0, kInfinity}, kInfinity};
  const double n = static_cast<double>(events.num_trials);
  rate.estimate = events.sum_weights / n;
  // The variance of w x, over n - 1: mean of squares minus square of mean.
  const double excess = std::max(0.0, events.sum_squared_weights / n - rate.estimate * rate.estimate);
  rate.standard_error = n > 1.0 ? std::sqrt(excess / (n - 1.0)) : kInfinity;
  if (events.sum_squared_weights > 0.0) {
    rate.num_effective_events = events.sum_weights * events.sum_weights / events.sum_squared_weights;
  }
  constexpr double kTail = 0.025;
  const double m = events.sum_weights > 0.0 ? events.max_event_weight : std::max(events.max_weight, 1.0);
  rate.interval = {LowerEnd(events, kTail) / n, UpperEnd(events, m, kTail) / n};
  rate.cautious_upper = UpperEnd(events, std::max(m, events.max_weight), kTail) / n;
  return rate;
}

}  // namespace rcme
