#include "stats/median_deviation.h"

#include <cmath>

#include "stats/median_ratio.h"

namespace rcme {

double MedianDeviation(const std::vector<double>& values) {
  const double median = MedianOf(values);
  std::vector<double> deviations;
  for (const double x : values) deviations.push_back(std::abs(x - median));
  return MedianOf(deviations);
}

}  // namespace rcme
