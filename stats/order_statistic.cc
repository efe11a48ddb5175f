#include "stats/order_statistic.h"

#include <algorithm>
#include <limits>

namespace rcme {

double ValueOfRank(std::size_t rank, std::vector<double>* values) {
  const auto at = values->begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values->begin(), at, values->end());
  return *at;
}

double ComputeQuantile(std::vector<double>& values, double probability) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  return ValueOfRank(static_cast<std::size_t>(probability * (static_cast<double>(values.size()) - 1)),
                     &values);
}

}  // namespace rcme
