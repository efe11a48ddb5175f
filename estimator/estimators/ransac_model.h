#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "estimator/estimator_model.h"
#include "estimator/ransac_options.h"

namespace rcme {

// The model of an estimator of the RANSAC family. Each shows only the options that have an effect on it.
class RansacModel : public EstimatorModel {
 public:
  void LiftLimits() final {
    options_.mu = kNoQualityTest;
    options_.inlier_ratio = std::numeric_limits<double>::quiet_NaN();  // inferred: the largest inlier set
                                                                       // always meets the condition
    options_.least_explained_share = 0.0;
  }
  std::optional<Effort> EffortOption() const final {
    return Effort{"num_iterations", std::isfinite(options_.early_stop_entropy)};
  }

 protected:
  RansacOptions options_;
};

// The model of an estimator without entropies. The tests of the refined motion are off by default, as the
// methods in the literature have none.
class PlainRansacModel : public RansacModel {
 protected:
  PlainRansacModel() { options_.observability_significance_level = options_.chance_significance_level = 1.0; }
  // The options of these estimators except those named.
  std::vector<Parameter> ParametersWithout(const std::vector<std::string>& names) {
    std::vector<Parameter> all = rcme::Parameters(options_);
    for (Parameter& level : MotionTestParameters(options_, /*depend_on_reading=*/false)) {
      all.push_back(std::move(level));
    }
    std::erase_if(all, [&](const Parameter& option) { return std::ranges::count(names, option.name()) > 0; });
    return all;
  }
};

}  // namespace rcme
