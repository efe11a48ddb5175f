// Estimates from numbers that depend on each other within clusters (the trials of a scene, the matches of a
// pair of images); clusters are independent.
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

// Of an estimate that moves by `influences[i]` because of observation i, which is of `clusters[i]`: with I_c
// the sum of the influences in cluster c of C,
//   standard error = sqrt(C / (C - 1) sum_c I_c^2),  interval = value +- t_(C-1) standard errors
// (the sandwich of Liang & Zeger 1986; for a mean, influences (x_i - mean) / n, Cochran 1977, 6.3). Holds for
// many clusters, none of which decides; of rare great influences the interval covers too little. Throws
// std::invalid_argument unless there are as many clusters as influences.
ClusteredEstimate EstimateFromInfluences(double value, std::span<const double> influences,
                                         std::span<const std::int64_t> clusters, double confidence = 0.95);

// The mean; every number counts once, large clusters so more than small ones. Each number a cluster of its
// own: Student's interval. NaN without numbers.
ClusteredEstimate MeasureClusteredMean(std::span<const double> numbers,
                                       std::span<const std::int64_t> clusters, double confidence = 0.95);

// The same of numbers in [0, greatest], with another interval: by betting on the sums of the clusters
// (score_mean.h), a confidence sequence. It holds for any law, also where the few great numbers that decide
// the mean have not been drawn; Student's is then a point. How many numbers a cluster has is taken as given.
// Throws std::invalid_argument for a number outside.
ClusteredEstimate MeasureBoundedClusteredMean(std::span<const double> numbers, double greatest,
                                              std::span<const std::int64_t> clusters,
                                              double confidence = 0.95);

}  // namespace rcme
