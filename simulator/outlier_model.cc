#include "simulator/outlier_model.h"

#include <cmath>

namespace rcme {

int OutlierModel::CountOf(int num_matches) const {
  return static_cast<int>(std::lround(outlier_ratio * num_matches));
}

std::vector<Parameter> Parameters(OutlierModel& outliers) {
  return {Parameter::Real("outlier_ratio", &outliers.outlier_ratio, {0.0, 1.0}, "",
                          "share of matches that are uniform mismatches, exact to one match")};
}

}  // namespace rcme
