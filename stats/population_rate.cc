#include "stats/population_rate.h"

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// Chosen by simulation, see the header.
constexpr double kLeastShareOfBinomial = 0.6;
constexpr double kManyConditions = 3.0, kReach = 8.0;
constexpr double kManyEvents = 10.0;

double Square(double x) { return x * x; }

// Shares of the conditions that have trials.
struct WeightedShares {
  std::vector<double> weights, shares, num_trials;  // a_i, q_i, n_i
  double effective = 0.0;                           // M
  double binomial = 0.0;                            // B / (p (1 - p)) = sum a_i^2 / n_i

  size_t size() const { return shares.size(); }
};

WeightedShares ComputeShares(std::span<const ConditionCount> conditions, ConditionWeights kind) {
  WeightedShares of;
  for (const ConditionCount& condition : conditions) {
    if (condition.num_events < 0 || condition.num_events > condition.num_trials)
      throw std::invalid_argument("population rate: a count is not in 0..num_trials");
    if (condition.num_trials == 0) continue;
    const double n = static_cast<double>(condition.num_trials);
    of.num_trials.push_back(n);
    of.shares.push_back(static_cast<double>(condition.num_events) / n);
    of.weights.push_back(kind == ConditionWeights::kEqual ? 1.0 : n);
  }
  const double sum = std::accumulate(of.weights.begin(), of.weights.end(), 0.0);
  for (double& weight : of.weights) weight /= sum;
  of.effective = KishEffectiveNumber(of.weights);
  for (size_t i = 0; i < of.size(); ++i) of.binomial += Square(of.weights[i]) / of.num_trials[i];
  return of;
}

// The inputs of the upper end; names as in the header.
struct Spread {
  double p = 0.0, V = 0.0;
  double num_events = 0.0;    // E
  double num_deciding = 0.0;  // c
  double greatest = 0.0;      // r, before clamping
};

Spread ComputeSpread(const WeightedShares& of) {
  Spread spread;
  for (size_t i = 0; i < of.size(); ++i) {
    spread.p += of.weights[i] * of.shares[i];
    spread.num_events += of.num_trials[i] * of.shares[i];
    spread.num_deciding += Square(of.weights[i] * of.shares[i]);
  }
  spread.num_deciding = Square(spread.p) / spread.num_deciding;
  const double m = static_cast<double>(of.size());
  for (size_t i = 0; i < of.size(); ++i) {
    const double difference = of.weights[i] * (of.shares[i] - spread.p);
    spread.V += m / (m - 1.0) * Square(difference);
    spread.greatest = std::max(spread.greatest, of.effective * difference);
  }
  return spread;
}

// h: near 1 if conditions may have different rates.
double Heterogeneity(const WeightedShares& of, const Spread& spread) {
  const int degrees_of_freedom = static_cast<int>(of.size()) - 1;
  const double B = spread.p * (1.0 - spread.p) * of.binomial;
  const double G = B > 0.0 ? ChiSquareCdf(degrees_of_freedom, degrees_of_freedom * spread.V / B) : 0.0;
  return std::max(Square(Square(G)), 1.0 / (1.0 + Square(spread.num_events / kManyEvents)));
}

// w: the share of events in the added condition.
double OneMore(const WeightedShares& of, const Spread& spread) {
  const double c = spread.num_deciding;
  const double r = std::clamp(spread.greatest, of.effective * of.binomial, 1.0);
  return 0.5 * (1.0 + kManyConditions / (c + kManyConditions)) *
         std::pow(r, c / (c + kReach * Heterogeneity(of, spread)));
}

double UpperEnd(const WeightedShares& of, double tail) {
  const double M = of.effective;
  const Spread spread = ComputeSpread(of);
  if (spread.p == 0.0) return 1.0 - std::pow(tail, 1.0 / M);
  const double t = StudentQuantile(std::max(M - 1.0, 1.0), 1.0 - tail), z = NormalQuantile(1.0 - tail);
  const double B = spread.p * (1.0 - spread.p) * of.binomial;
  const double S = Square(M) * std::max(spread.V * Square(t / z), kLeastShareOfBinomial * B);
  const double w = OneMore(of, spread), sum = M * spread.p + w;
  const double p = sum / (M + w);
  if (p >= 1.0) return 1.0;
  const double size = std::clamp((S + Square(w)) / (sum * (1.0 - p)), 0.5 * M * of.binomial, 1.0);
  const double N = (M + w) / size;
  return std::max(spread.p, boost::math::ibeta_inv(p * N, (1.0 - p) * N, 1.0 - tail));
}

WeightedShares OfNonEvents(WeightedShares of) {
  for (double& share : of.shares) share = 1.0 - share;
  return of;
}

// One-way analysis of variance (Donner 1986); conditions may differ in size, with mean size (N - sum n_i^2 /
// N) / (m - 1).
double IntraclassCorrelation(const WeightedShares& of) {
  const double m = static_cast<double>(of.size());
  double N = 0.0, squares = 0.0, events = 0.0, within = 0.0;
  for (size_t i = 0; i < of.size(); ++i) {
    const double n = of.num_trials[i], q = of.shares[i];
    N += n, squares += n * n, events += n * q, within += n * q * (1.0 - q);
  }
  if (of.size() < 2 || N == m) return kNaN;
  double between = 0.0;
  for (size_t i = 0; i < of.size(); ++i) between += of.num_trials[i] * Square(of.shares[i] - events / N);
  between /= m - 1.0, within /= N - m;
  const double total = between + ((N - squares / N) / (m - 1.0) - 1.0) * within;
  return total > 0.0 ? (between - within) / total : kNaN;
}

// The exact interval for a number of trials that need not be an integer.
Interval ExactInterval(double p, double n, double tail) {
  const double k = p * n;
  return {p <= 0.0 ? 0.0 : boost::math::ibeta_inv(k, n - k + 1.0, tail),
          p >= 1.0 ? 1.0 : boost::math::ibeta_inv(k + 1.0, n - k, 1.0 - tail)};
}

double Correlation(const WeightedShares& a, const WeightedShares& b, double mean_a, double mean_b) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (size_t i = 0; i < a.size(); ++i) {
    const double weight = Square(a.weights[i]), u = a.shares[i] - mean_a, v = b.shares[i] - mean_b;
    ab += weight * u * v, aa += weight * u * u, bb += weight * v * v;
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

// Zou & Donner's distance between an end and the difference.
double Distance(double d1, double d2, double r) {
  return std::sqrt(std::max(0.0, d1 * d1 + d2 * d2 - 2.0 * r * d1 * d2));
}

}  // namespace

double KishEffectiveNumber(std::span<const double> weights) {
  double sum = 0.0, squares = 0.0;
  for (const double weight : weights) sum += weight, squares += weight * weight;
  return sum * sum / squares;
}

PopulationRate MeasurePopulationRate(std::span<const ConditionCount> conditions, ConditionWeights weights,
                                     double confidence) {
  PopulationRate rate;
  const WeightedShares of = ComputeShares(conditions, weights);
  for (const ConditionCount& condition : conditions) {
    rate.num_events += condition.num_events;
    rate.n += condition.num_trials;
  }
  rate.num_conditions = std::ssize(of.shares);
  rate.intraclass_correlation = IntraclassCorrelation(of);
  rate.interval = rate.of_these_conditions = {0.0, 1.0};
  rate.value = rate.effective_n = kNaN;
  if (rate.n == 0) return rate;
  const Spread spread = ComputeSpread(of);
  const double tail = 0.5 * (1.0 - confidence), n = static_cast<double>(rate.n);
  rate.value = std::min(spread.p, 1.0);
  rate.of_these_conditions = ExactInterval(rate.value, 1.0 / of.binomial, tail);
  if (of.size() < 2) return rate;
  if (spread.V > 0.0) rate.effective_n = std::min(n, rate.value * (1.0 - rate.value) / spread.V);
  rate.interval = {1.0 - UpperEnd(OfNonEvents(of), tail), UpperEnd(of, tail)};
  return rate;
}

PopulationDifference MeasurePopulationDifference(std::span<const ConditionPair> conditions,
                                                 ConditionWeights weights, double confidence) {
  std::vector<ConditionCount> first, second;
  for (const ConditionPair& condition : conditions) {
    if (condition.num_first_only + condition.num_second_only > condition.num_trials)
      throw std::invalid_argument("population rate: more trials with one event than trials");
    first.push_back({condition.num_first_only, condition.num_trials});
    second.push_back({condition.num_second_only, condition.num_trials});
  }
  PopulationDifference difference;
  difference.first_only = MeasurePopulationRate(first, weights, confidence);
  difference.second_only = MeasurePopulationRate(second, weights, confidence);
  const PopulationRate &a = difference.first_only, &b = difference.second_only;
  difference.value = a.value - b.value;
  difference.interval = {-1.0, 1.0};
  if (a.num_conditions < 2) return difference;
  const double r =
      Correlation(ComputeShares(first, weights), ComputeShares(second, weights), a.value, b.value);
  difference.interval = {
      std::max(-1.0, difference.value - Distance(a.value - a.interval.lower, b.interval.upper - b.value, r)),
      std::min(1.0, difference.value + Distance(a.interval.upper - a.value, b.value - b.interval.lower, r))};
  return difference;
}

}  // namespace rcme
