#pragma once

#include <cmath>
#include <limits>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

// An estimator of the RANSAC family with its options, of which each shows those that have an effect on it.
class RansacModel : public EstimatorModel {
 public:
  void LiftLimits() final {
    options_.mu = kNoQualityTest;
    options_.inlier_ratio = std::numeric_limits<double>::quiet_NaN();  // inferred: the largest set is enough
    options_.least_explained_share = 0.0;
  }
  std::optional<Effort> EffortOption() const final {
    return Effort{"num_iterations", std::isfinite(options_.early_stop_entropy)};
  }

 protected:
  RansacOptions options_;
};

}  // namespace rcme
