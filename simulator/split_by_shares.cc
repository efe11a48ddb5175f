#include "simulator/split_by_shares.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rcme {

std::vector<int> SplitByShares(int total, const std::vector<double>& shares) {
  const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
  std::vector<int> counts;
  std::vector<double> remainders;
  for (const double share : shares) {
    const double exact = total * (share / sum);
    counts.push_back(static_cast<int>(std::floor(exact)));
    remainders.push_back(exact - std::floor(exact));
  }
  for (int missing = total - std::accumulate(counts.begin(), counts.end(), 0); missing > 0; --missing) {
    const auto largest = std::ranges::max_element(remainders);
    ++counts[static_cast<size_t>(largest - remainders.begin())];
    *largest = -1.0;
  }
  return counts;
}

}  // namespace rcme
