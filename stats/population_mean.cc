#include "stats/population_mean.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// Moments of a condition with its weight a_i.
struct WeightedCondition {
  Moments moments;
  double weight = 0.0;
};

std::vector<WeightedCondition> WithWeights(std::span<const Moments> conditions, ConditionWeights kind) {
  std::vector<WeightedCondition> weighted;
  double sum = 0.0;
  for (const Moments& moments : conditions) {
    if (moments.n() == 0) continue;
    weighted.push_back({moments, kind == ConditionWeights::kEqual ? 1.0 : static_cast<double>(moments.n())});
    sum += weighted.back().weight;
  }
  for (WeightedCondition& condition : weighted) condition.weight /= sum;
  return weighted;
}

// value +- t sqrt(variance); unbounded if the variance or degrees of freedom are not valid.
Interval StudentAround(double value, double variance, double degrees_of_freedom, double confidence) {
  if (!std::isfinite(variance) || !(degrees_of_freedom > 0.0)) return {-kInfinity, kInfinity};
  const double half =
      StudentQuantile(std::max(degrees_of_freedom, 1.0), 0.5 * (1.0 + confidence)) * std::sqrt(variance);
  return {value - half, value + half};
}

// The interval from a statistic with this variance, corrected for its skewness k, for which the weighted
// deviations d_i = a_i (x_i - value) are the data: k = sum d_i^3 / (sum d_i^2)^(3/2). With the studentised
// mean T, T + k T^2 / 3 + k^2 T^3 / 27 + k / 6 is nearly normal, and this cubic is inverted at the quantiles
// of Student's law (Hall 1992).
Interval HallInterval(double value, double variance, double k, double degrees_of_freedom, double confidence) {
  const Interval student = StudentAround(value, variance, degrees_of_freedom, confidence);
  if (!(std::abs(k) > 1e-6) || !std::isfinite(student.upper)) return student;
  const double half = student.upper - value, se = std::sqrt(variance);
  const auto distance = [&](double t) { return 3.0 / k * (std::cbrt(1.0 + k * t - k * k / 6.0) - 1.0) * se; };
  return {value - distance(half / se), value - distance(-half / se)};
}

Interval OfTheseConditions(const std::vector<WeightedCondition>& conditions, double value,
                           double confidence) {
  double variance = 0.0, fourth = 0.0;
  for (const auto& [moments, weight] : conditions) {
    const double part = weight * weight * moments.variance() / static_cast<double>(moments.n());
    variance += part;
    fourth += part * part / static_cast<double>(moments.n() - 1);
  }
  if (variance == 0.0) return {value, value};
  return StudentAround(value, variance, variance * variance / fourth, confidence);
}

}  // namespace

PopulationMean MeasurePopulationMean(std::span<const Moments> given, ConditionWeights weights,
                                     double confidence) {
  const std::vector<WeightedCondition> conditions = WithWeights(given, weights);
  PopulationMean mean;
  mean.num_conditions = std::ssize(conditions);
  mean.value = mean.standard_error = mean.effective_n = kNaN;
  mean.interval = mean.of_these_conditions = {-kInfinity, kInfinity};
  if (conditions.empty()) return mean;
  double sum = 0.0, squares_of_weights = 0.0;
  for (const auto& [moments, weight] : conditions) {
    mean.n += moments.n();
    sum += weight * moments.mean();
    squares_of_weights += weight * weight;
  }
  mean.value = sum;
  double between = 0.0, cubes = 0.0, total = 0.0;
  for (const auto& [moments, weight] : conditions) {
    const double difference = moments.mean() - mean.value, weighted = weight * difference;
    between += weighted * weighted;
    cubes += weighted * weighted * weighted;
    total += weight * (difference * difference + moments.variance());
  }
  mean.of_these_conditions = OfTheseConditions(conditions, mean.value, confidence);
  if (conditions.size() < 2) return mean;
  const double m = static_cast<double>(conditions.size()), V = m / (m - 1.0) * between;
  mean.standard_error = std::sqrt(V);
  mean.interval =
      HallInterval(mean.value, V, cubes / std::pow(between, 1.5), 1.0 / squares_of_weights - 1.0, confidence);
  if (V > 0.0 && !std::isnan(total)) mean.effective_n = std::min(static_cast<double>(mean.n), total / V);
  return mean;
}

}  // namespace rcme
