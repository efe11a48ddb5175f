#include "stats/area_under_curve.h"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <stdexcept>

namespace rcme {
namespace {

// The scores of one kind in one cluster: their number and the sum of their placements.
struct Placements {
  double count = 0.0, sum = 0.0;
};

std::vector<double> SortedScores(const std::vector<ScoreCluster>& clusters,
                                 std::vector<double> ScoreCluster::*kind) {
  std::vector<double> scores;
  for (const ScoreCluster& cluster : clusters) {
    scores.insert(scores.end(), (cluster.*kind).begin(), (cluster.*kind).end());
  }
  if (scores.empty()) throw std::invalid_argument("area under the curve: no scores of one kind");
  for (const double score : scores) {
    if (std::isnan(score)) throw std::invalid_argument("area under the curve: a score is NaN");
  }
  std::sort(scores.begin(), scores.end());
  return scores;
}

// The share of `sorted` that is below x, equal ones counting half.
double ShareBelow(const std::vector<double>& sorted, double x) {
  const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), x);
  return 0.5 * static_cast<double>((low - sorted.begin()) + (high - sorted.begin())) /
         static_cast<double>(sorted.size());
}

Placements ComputePlacements(const std::vector<double>& scores, const std::vector<double>& sorted_others,
                             bool is_positive) {
  Placements placements;
  for (const double score : scores) {
    const double below = ShareBelow(sorted_others, score);
    placements.sum += is_positive ? below : 1.0 - below;
  }
  placements.count = static_cast<double>(scores.size());
  return placements;
}

// Mean placement of one kind over all clusters and its variance, after adding `added` clusters of mean size
// with placement 0 and as many with placement 1.
struct ClusterMean {
  double num_clusters = 0.0, count = 0.0, mean = 0.0, variance = 0.0;

  ClusterMean(const std::vector<Placements>& clusters, double added) {
    double sum = 0.0;
    for (const Placements& c : clusters) num_clusters += c.count > 0.0, count += c.count, sum += c.sum;
    const double size = count / num_clusters;
    num_clusters += 2.0 * added;
    count += 2.0 * added * size;
    mean = (sum + added * size) / count;
    double squares = added * size * size * (mean * mean + (1.0 - mean) * (1.0 - mean));
    for (const Placements& c : clusters) squares += std::pow(c.sum - c.count * mean, 2.0);
    variance = num_clusters / (num_clusters - 1.0) * squares / (count * count);
  }
};

// S11 of the header: the covariance of both kinds within clusters.
double ComputePlacementCovariance(const std::vector<Placements>& positives,
                                  const std::vector<Placements>& negatives, const ClusterMean& positive_mean,
                                  const ClusterMean& negative_mean) {
  double products = 0.0;
  for (size_t c = 0; c < positives.size(); ++c) {
    products += (positives[c].sum - positives[c].count * positive_mean.mean) *
                (negatives[c].sum - negatives[c].count * negative_mean.mean);
  }
  const double n = static_cast<double>(positives.size());
  return n > 1.0 ? n / (n - 1.0) * products / (positive_mean.count * negative_mean.count) : 0.0;
}

// Student's interval on the log odds of an area whose estimate, not 0 or 1, has this variance.
Interval LogOddsInterval(double area, double variance, double degrees_of_freedom, double confidence) {
  const boost::math::students_t law(degrees_of_freedom);  // a fractional number is allowed
  const double half = quantile(law, 0.5 * (1.0 + confidence)) * std::sqrt(variance) / (area * (1.0 - area));
  const double log_odds = std::log(area / (1.0 - area));
  return {1.0 / (1.0 + std::exp(half - log_odds)), 1.0 / (1.0 + std::exp(-half - log_odds))};
}

Interval ComputeAreaInterval(double area, const std::vector<Placements>& positives,
                             const std::vector<Placements>& negatives, double confidence) {
  const ClusterMean p(positives, 0.5), n(negatives, 0.5);
  const double least = std::min(p.num_clusters, n.num_clusters);  // includes the added cluster
  if (least < 3.0) return {0.0, 1.0};
  if (area == 0.0 || area == 1.0) {
    const double num_pairs = std::min(least - 1.0, std::floor(0.5 * static_cast<double>(positives.size())));
    const double end = std::pow(0.5 * (1.0 - confidence), 1.0 / num_pairs);
    return area == 1.0 ? Interval{end, 1.0} : Interval{0.0, 1.0 - end};
  }
  const double centre = ((least - 1.0) * area + 0.5) / least;
  const double variance =
      p.variance + n.variance + 2.0 * ComputePlacementCovariance(positives, negatives, p, n);
  const double degrees_of_freedom =
      variance * variance /
      (p.variance * p.variance / (p.num_clusters - 1.0) + n.variance * n.variance / (n.num_clusters - 1.0));
  return LogOddsInterval(centre, variance, std::max(1.0, degrees_of_freedom), confidence);
}

}  // namespace

AreaUnderCurve MeasureClusteredAreaUnderCurve(const std::vector<ScoreCluster>& clusters, double confidence) {
  const std::vector<double> all_negatives = SortedScores(clusters, &ScoreCluster::negatives);
  const std::vector<double> all_positives = SortedScores(clusters, &ScoreCluster::positives);
  std::vector<Placements> positives, negatives;
  for (const ScoreCluster& cluster : clusters) {
    positives.push_back(ComputePlacements(cluster.positives, all_negatives, true));
    negatives.push_back(ComputePlacements(cluster.negatives, all_positives, false));
  }
  const ClusterMean p(positives, 0.0), n(negatives, 0.0);
  AreaUnderCurve area;
  area.value = p.mean;
  const double variance =
      p.variance + n.variance + 2.0 * ComputePlacementCovariance(positives, negatives, p, n);
  area.standard_error = std::sqrt(variance < 0.0 ? 0.0 : variance);  // below zero by rounding only
  area.interval = ComputeAreaInterval(area.value, positives, negatives, confidence);
  return area;
}

AreaUnderCurve MeasureAreaUnderCurve(const std::vector<double>& negatives,
                                     const std::vector<double>& positives, double confidence) {
  std::vector<ScoreCluster> clusters;
  for (const double score : negatives) clusters.push_back({{score}, {}});
  for (const double score : positives) clusters.push_back({{}, {score}});
  return MeasureClusteredAreaUnderCurve(clusters, confidence);
}

bool IsBelow(double a, double b, RandomStream& rng) { return a == b ? rng.Uniform() < 0.5 : a < b; }

}  // namespace rcme
