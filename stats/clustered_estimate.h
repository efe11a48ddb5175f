// Estimates from numbers that depend on each other within clusters (the trials of a scene, the matches of an
// image pair). Clusters are independent.
#pragma once

#include <cstdint>
#include <span>

#include "stats/intervals.h"

namespace rcme {

struct ClusteredEstimate {
  double value = 0.0;
  double standard_error = 0.0;  // NaN with one cluster
  Interval interval;            // unbounded with one cluster
  std::int64_t n = 0, num_clusters = 0;
};

// The standard error and interval of an estimate. `influences[i]` is the change of the estimate due to
// observation i, which belongs to `clusters[i]`. With I_c the sum of the influences in cluster c of C,
//   standard error = sqrt(C / (C - 1) sum_c I_c^2),  interval = value +- t_(C-1) standard errors
// (the sandwich of Liang & Zeger 1986; for a mean, influences (x_i - mean) / n, Cochran 1977, 6.3). Valid for
// many clusters of which none dominates; with rare large influences the interval covers too little. Throws
// std::invalid_argument unless there are as many clusters as influences.
ClusteredEstimate EstimateFromInfluences(double value, std::span<const double> influences,
                                         std::span<const std::int64_t> clusters, double confidence = 0.95);

// The mean of all numbers, so large clusters weigh more. If each number is a cluster of its own, the interval
// is Student's. NaN without numbers.
ClusteredEstimate MeasureClusteredMean(std::span<const double> numbers,
                                       std::span<const std::int64_t> clusters, double confidence = 0.95);

// The mean of numbers in a range with an interval by betting on the sums of the clusters
// (score_mean.h), a confidence sequence. It is valid for any law, even if the few large numbers that dominate
// the mean were not drawn; Student's interval is then a point. The sizes of the clusters are taken as fixed.
// Throws std::invalid_argument for a number out of range.
ClusteredEstimate MeasureBoundedClusteredMean(std::span<const double> numbers, const Interval& range,
                                              std::span<const std::int64_t> clusters,
                                              double confidence = 0.95);

}  // namespace rcme
