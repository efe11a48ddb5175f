#include "stats/conformal.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stats/constants.h"

namespace rcme {

double ConformalBound(std::span<const double> scores, std::span<const double> shares, double level) {
  if (scores.size() != shares.size() || !(level > 0.0 && level < 1.0) ||
      !std::ranges::all_of(shares, [](double share) { return share > 0.0 && share <= 1.0; }))
    throw std::invalid_argument("a conformal bound needs a share for each score and a level in (0, 1)");
  std::vector<std::pair<double, double>> falling;  // score, share
  double total = 0.0;
  for (size_t i = 0; i < scores.size(); ++i) {
    falling.emplace_back(scores[i], shares[i]);
    total += shares[i];
  }
  std::ranges::sort(falling, std::greater<>());
  // Rounding must not lose sums that are integers.
  constexpr double kRounding = 1e-9;
  const double may_exceed = (1.0 - level) * total - level + kRounding;
  if (may_exceed < 0.0) return kInfinity;
  double beyond = 0.0;  // shares of the scores above the bound; never all of them
  size_t i = 0;
  while (beyond + falling[i].second <= may_exceed) beyond += falling[i++].second;
  return falling[i].first;
}

std::int64_t FewestGroupsForBound(double level) {
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("a level is in (0, 1)");
  constexpr double kRounding = 1e-9;
  return static_cast<std::int64_t>(std::ceil(level / (1.0 - level) - kRounding));
}

double ConformalPValue(std::span<const double> reference, double score) {
  const auto n = static_cast<double>(reference.size());
  const auto below = std::ranges::lower_bound(reference, score) - reference.begin();
  return (1.0 + n - static_cast<double>(below)) / (n + 1.0);
}

}  // namespace rcme
