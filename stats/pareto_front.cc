#include "stats/pareto_front.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace rcme {
namespace {

void CheckPoints(const std::vector<double>& first, const std::vector<double>& second) {
  const auto is_nan = [](double x) { return std::isnan(x); };
  if (first.size() != second.size() || std::ranges::any_of(first, is_nan) ||
      std::ranges::any_of(second, is_nan))
    throw std::invalid_argument("Pareto front: two coordinates of each point are needed");
}

}  // namespace

std::vector<size_t> ParetoFront(const std::vector<double>& first, const std::vector<double>& second,
                                TiesOfFirst ties) {
  CheckPoints(first, second);
  std::vector<size_t> order(first.size()), front;
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, {}, [&](size_t i) { return std::pair(first[i], second[i]); });
  double least_of_lower = std::numeric_limits<double>::infinity();  // second ones, at smaller first ones
  bool has_lower = false;
  for (size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    const double least = second[order[begin]];  // least second one of those with this first one
    for (end = begin; end < order.size() && first[order[end]] == first[order[begin]]; ++end) {
      const double value = second[order[end]];
      const bool may_stay = ties == TiesOfFirst::kStay || value == least;
      if (may_stay && (!has_lower || value < least_of_lower)) front.push_back(order[end]);
    }
    least_of_lower = std::min(least_of_lower, least);
    has_lower = true;
  }
  return front;
}

}  // namespace rcme
