#include "stats/median_deviation.h"

#include <cmath>

#include "stats/median_ratio.h"

namespace rcme {

double MedianDeviation(const std::vector<double>& values) {
  const double median = ComputeMedian(values);
  std::vector<double> deviations;
  for (const double x : values) deviations.push_back(std::abs(x - median));
  return ComputeMedian(deviations);
}

}  // namespace rcme
