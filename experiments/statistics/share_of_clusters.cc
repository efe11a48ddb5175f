#include "experiments/statistics/share_of_clusters.h"

#include <algorithm>
#include <set>

#include "stats/clustered_estimate.h"

namespace rcme {

ClusteredShare MeasureShareOfClusters(const std::vector<bool>& holds,
                                      const std::vector<std::int64_t>& clusters) {
  const std::set<std::int64_t> different(clusters.begin(), clusters.end());
  ClusteredShare share;
  share.n = std::ssize(holds);
  share.count = std::ranges::count(holds, true);
  share.has_shared_clusters = std::ssize(different) < share.n;
  const std::vector<double> numbers(holds.begin(), holds.end());
  share.interval = share.has_shared_clusters
                       ? MeasureBoundedClusteredMean(numbers, {0.0, 1.0}, clusters).interval
                       : ExactBinomialInterval(share.count, share.n);
  return share;
}

}  // namespace rcme
