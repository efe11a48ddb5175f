#pragma once

#include <vector>

#include "parameters/parameter.h"

namespace rcme {

// Uniform mismatches: of n matches exactly round(outlier_ratio n) have their point in image 2 replaced by a
// uniform one.
struct OutlierModel {
  double outlier_ratio = 0.2;

  int CountOf(int num_matches) const;
};
std::vector<Parameter> Parameters(OutlierModel& outliers);

}  // namespace rcme
