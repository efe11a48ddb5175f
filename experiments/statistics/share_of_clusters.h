// A share of answers with its interval, where some of them depend on each other.
#pragma once

#include <cstdint>
#include <vector>

#include "stats/intervals.h"

namespace rcme {

struct ClusteredShare {
  std::int64_t count = 0, n = 0;
  bool has_shared_clusters = false;  // some cluster has several answers
  Interval interval;

  double value() const { return static_cast<double>(count) / static_cast<double>(n); }
};

// `holds` by answer, `clusters` the same: exact where every answer is a cluster of its own, else by betting
// on the sums of the clusters (stats/clustered_estimate.h). There is at least one answer.
ClusteredShare MeasureShareOfClusters(const std::vector<bool>& holds,
                                      const std::vector<std::int64_t>& clusters);

}  // namespace rcme
