#include "stats/sparsification.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/ranked_loss.h"

namespace rcme {
namespace {

ClusteredEstimate EstimateNotNegative(double value, const std::vector<double>& influences,
                                      const std::vector<std::int64_t>& clusters) {
  ClusteredEstimate estimate = EstimateFromInfluences(value, influences, clusters);
  estimate.interval.lower = std::max(estimate.interval.lower, 0.0);
  return estimate;
}

}  // namespace

Sparsification MeasureSparsification(std::span<const StatedError> errors) {
  std::vector<double> by_stated, by_error, losses;
  std::vector<std::int64_t> clusters;
  for (const StatedError& error : errors) {
    if (error.error < 0.0) throw std::invalid_argument("sparsification: an error is negative");
    by_stated.push_back(-error.stated);
    by_error.push_back(-error.error);
    losses.push_back(error.error);
    clusters.push_back(error.cluster);
  }
  const RankedLoss stated = MeasureRankedLoss(by_stated, losses);
  const RankedLoss oracle = MeasureRankedLoss(by_error, losses);
  const double mean = stated.mean;
  if (mean == 0.0) {
    const ClusteredEstimate none{kNaN, kNaN, {0.0, kInfinity}, std::ssize(errors), 0};
    return {none, none};
  }
  const double ause = (stated.area - oracle.area) / mean, ause_random = 1.0 - oracle.area / mean;
  std::vector<double> influences, random_influences;
  for (size_t i = 0; i < losses.size(); ++i) {
    const double of_mean = stated.mean_influences[i];
    influences.push_back((stated.influences[i] - oracle.influences[i] - ause * of_mean) / mean);
    random_influences.push_back((of_mean - oracle.influences[i] - ause_random * of_mean) / mean);
  }
  return {EstimateNotNegative(ause, influences, clusters),
          EstimateNotNegative(ause_random, random_influences, clusters)};
}

}  // namespace rcme
