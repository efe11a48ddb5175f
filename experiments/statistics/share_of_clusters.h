// A share of answers with its interval, for answers that depend on each other within clusters.
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

// `holds` and `clusters` have an element per answer, at least one. The interval is exact if every answer is
// a cluster of its own; otherwise it is by betting on the sums of clusters (stats/clustered_estimate.h).
ClusteredShare MeasureShareOfClusters(const std::vector<bool>& holds,
                                      const std::vector<std::int64_t>& clusters);

}  // namespace rcme
