#include "stats/conformal.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stats/constants.h"

namespace rcme {

double ConformalBound(std::span<const double> scores, std::span<const std::int64_t> groups, double level) {
  if (scores.size() != groups.size() || !(level > 0.0 && level < 1.0))
    throw std::invalid_argument("a conformal bound needs a group for each score and a level in (0, 1)");
  std::map<std::int64_t, std::int64_t> sizes;
  for (const std::int64_t group : groups) ++sizes[group];
  std::vector<std::pair<double, double>> weighted;  // score, weight in groups
  for (size_t i = 0; i < scores.size(); ++i)
    weighted.emplace_back(scores[i], 1.0 / static_cast<double>(sizes[groups[i]]));
  std::ranges::sort(weighted);
  const double wanted = level * static_cast<double>(sizes.size() + 1);
  // Sums of weights that are whole groups must not be missed by rounding.
  constexpr double kRounding = 1e-9;
  double sum = 0.0;
  for (const auto& [score, weight] : weighted) {
    sum += weight;
    if (sum >= wanted - kRounding) return score;
  }
  return kInfinity;
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
