#include "stats/clustered_estimate.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/score_mean.h"

namespace rcme {
namespace {

// In ascending order of the clusters.
std::vector<double> SumsByCluster(std::span<const double> numbers, std::span<const std::int64_t> clusters) {
  std::vector<size_t> order(numbers.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return clusters[a] < clusters[b]; });
  std::vector<double> sums;
  for (size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || clusters[order[i]] != clusters[order[i - 1]]) sums.push_back(0.0);
    sums.back() += numbers[order[i]];
  }
  return sums;
}

}  // namespace

ClusteredEstimate EstimateFromInfluences(double value, std::span<const double> influences,
                                         std::span<const std::int64_t> clusters, double confidence) {
  if (influences.size() != clusters.size())
    throw std::invalid_argument("clustered estimate: not as many clusters as numbers");
  const std::vector<double> sums = SumsByCluster(influences, clusters);
  const std::int64_t num_clusters = std::ssize(sums);
  if (num_clusters < 2) return {value, kNaN, {-kInfinity, kInfinity}, std::ssize(influences), num_clusters};
  const double squares = std::inner_product(sums.begin(), sums.end(), sums.begin(), 0.0);
  const double C = static_cast<double>(num_clusters);
  const double standard_error = std::sqrt(C / (C - 1.0) * squares);
  const double half =
      StudentQuantile(static_cast<int>(num_clusters - 1), 0.5 * (1.0 + confidence)) * standard_error;
  return {value, standard_error, {value - half, value + half}, std::ssize(influences), num_clusters};
}

ClusteredEstimate MeasureClusteredMean(std::span<const double> numbers,
                                       std::span<const std::int64_t> clusters, double confidence) {
  const double n = static_cast<double>(numbers.size());
  const double mean = std::accumulate(numbers.begin(), numbers.end(), 0.0) / n;
  std::vector<double> influences(numbers.begin(), numbers.end());
  for (double& x : influences) x = (x - mean) / n;
  return EstimateFromInfluences(mean, influences, clusters, confidence);
}

ClusteredEstimate MeasureBoundedClusteredMean(std::span<const double> numbers, const Interval& range,
                                              std::span<const std::int64_t> clusters, double confidence) {
  ClusteredEstimate mean = MeasureClusteredMean(numbers, clusters, confidence);
  if (!std::ranges::all_of(numbers, [&](double x) { return x >= range.lower && x <= range.upper; }))
    throw std::invalid_argument("clustered estimate: a number is outside of its range");
  mean.interval = range;
  if (numbers.empty()) return mean;
  std::vector<double> above(numbers.begin(), numbers.end());
  for (double& x : above) x -= range.lower;
  const std::vector<double> ones(numbers.size(), 1.0);
  const std::vector<double> sums = SumsByCluster(above, clusters), sizes = SumsByCluster(ones, clusters);
  const double largest = (range.upper - range.lower) * *std::ranges::max_element(sizes);
  ScoreMean shares;  // sums over the greatest possible sum
  for (const double sum : sums) shares.Add(std::min(1.0, sum / largest));
  const Interval interval = shares.Sequence(confidence);
  const double scale = largest * static_cast<double>(sums.size()) / static_cast<double>(numbers.size());
  mean.interval = {range.lower + scale * interval.lower,
                   std::min(range.upper, range.lower + scale * interval.upper)};
  return mean;
}

}  // namespace rcme
