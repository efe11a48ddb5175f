#include "stats/pit_bands.h"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <stdexcept>

namespace rcme {
namespace {

constexpr int kMaxValues = 100'000, kMaxPoints = 1000;

double LogPoisson(int k, double mean) {
  return k * std::log(mean) - mean - boost::math::lgamma(static_cast<double>(k) + 1.0);
}

// Poisson(mean) probabilities of 0..max_k. Those below 1e-40 are 0.
std::vector<double> PoissonProbabilities(double mean, int max_k) {
  std::vector<double> probabilities;
  for (int k = 0; k <= max_k; ++k) {
    const double log_p = LogPoisson(k, mean);
    if (k > mean && log_p < -92.0) break;
    probabilities.push_back(log_p < -92.0 ? 0.0 : std::exp(log_p));
  }
  return probabilities;
}

// The pointwise intervals at level gamma: P(count < lower) <= gamma / 2 and P(count > upper) <= gamma / 2.
void SetPointwiseIntervals(PitBands& bands) {
  using boost::math::policies::discrete_quantile;
  using boost::math::policies::integer_round_up;
  using Policy = boost::math::policies::policy<discrete_quantile<integer_round_up>>;
  const double tail = 0.5 * bands.pointwise_level;
  for (size_t i = 0; i < bands.z.size(); ++i) {
    const boost::math::binomial_distribution<double, Policy> law(bands.n, bands.z[i]);
    const bool is_last = i + 1 == bands.z.size();
    bands.lower[i] = is_last ? bands.n : static_cast<int>(quantile(law, tail));
    bands.upper[i] = is_last ? bands.n : static_cast<int>(quantile(complement(law, tail)));
  }
}

PitBands BandsAtLevel(int n, int num_points, double pointwise_level) {
  PitBands bands;
  bands.n = n;
  bands.pointwise_level = pointwise_level;
  for (int i = 1; i <= num_points; ++i) bands.z.push_back(static_cast<double>(i) / num_points);
  bands.lower.resize(bands.z.size());
  bands.upper.resize(bands.z.size());
  SetPointwiseIntervals(bands);
  bands.simultaneous_coverage = SimultaneousCoverage(n, bands.lower, bands.upper);
  return bands;
}

}  // namespace

double SimultaneousCoverage(int n, const std::vector<int>& lower, const std::vector<int>& upper) {
  // The counts are a Markov chain with binomial increments, which is the chain with Poisson(n / K) increments
  // given that it ends at n: so one table of increments serves every step and state, and the condition is
  // divided out at the end.
  const std::vector<double> increment =
      PoissonProbabilities(static_cast<double>(n) / static_cast<double>(lower.size()), n);
  const int max_increment = static_cast<int>(increment.size()) - 1;
  std::vector<double> inside = {1.0};  // P(in the band so far, count = first + index)
  int first = 0;
  for (size_t i = 0; i < lower.size(); ++i) {
    const int next_first = std::max(lower[i], 0), next_last = std::min(upper[i], n);
    if (next_first > next_last) return 0.0;
    std::vector<double> next(static_cast<size_t>(next_last - next_first) + 1, 0.0);
    for (int from = first; from < first + static_cast<int>(inside.size()); ++from) {
      const double p = inside[static_cast<size_t>(from - first)];
      const int low = std::max(from, next_first), high = std::min(from + max_increment, next_last);
      for (int to = low; to <= high; ++to) {
        next[static_cast<size_t>(to - next_first)] += p * increment[static_cast<size_t>(to - from)];
      }
    }
    inside = std::move(next);
    first = next_first;
  }
  const int at_n = n - first;
  if (at_n < 0 || at_n >= static_cast<int>(inside.size())) return 0.0;
  return inside[static_cast<size_t>(at_n)] / std::exp(LogPoisson(n, n));
}

PitBands SimultaneousPitBands(int n, int num_points, double confidence) {
  if (n < 1 || n > kMaxValues) throw std::invalid_argument("PIT bands: n must be 1..100000");
  if (num_points < 2 || num_points > kMaxPoints)
    throw std::invalid_argument("PIT bands: points must be 2..1000");
  if (!(confidence > 0.0 && confidence < 1.0))
    throw std::invalid_argument("PIT bands: confidence must be in (0, 1)");
  // The coverage is a falling step function of gamma. At alpha / (K - 1) it suffices (Bonferroni); at alpha
  // it may, if the steps are coarse.
  const double alpha = 1.0 - confidence;
  PitBands best = BandsAtLevel(n, num_points, alpha / (num_points - 1));
  double too_large = std::log(alpha), small = std::log(best.pointwise_level);
  const PitBands widest_level = BandsAtLevel(n, num_points, alpha);
  if (widest_level.simultaneous_coverage >= confidence) return widest_level;
  for (int i = 0; i < 22; ++i) {
    const double middle = 0.5 * (small + too_large);
    PitBands bands = BandsAtLevel(n, num_points, std::exp(middle));
    if (bands.simultaneous_coverage < confidence) {
      too_large = middle;
    } else {
      small = middle;
      best = std::move(bands);
    }
  }
  return best;
}

PitCheck CheckPit(const std::vector<double>& values, const PitBands& bands) {
  if (values.size() != static_cast<size_t>(bands.n))
    throw std::invalid_argument("PIT bands: wrong number of values");
  PitCheck check;
  check.counts.resize(bands.z.size());
  for (const double u : values) {
    if (!(u >= 0.0 && u <= 1.0)) {
      ++check.num_invalid;
      continue;
    }
    ++check
          .counts[static_cast<size_t>(std::lower_bound(bands.z.begin(), bands.z.end(), u) - bands.z.begin())];
  }
  for (size_t i = 0; i < check.counts.size(); ++i) {
    if (i > 0) check.counts[i] += check.counts[i - 1];
    if (check.counts[i] < bands.lower[i] || check.counts[i] > bands.upper[i]) {
      check.outside.push_back(static_cast<int>(i));
    }
  }
  return check;
}

}  // namespace rcme
