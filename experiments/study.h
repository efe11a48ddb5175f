#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "estimator/ransac_options.h"
#include "experiments/data_source.h"

namespace rcme {

// When a returned motion counts as failed.
struct FailureBounds {
  double max_rotation_error_deg = 3.0;
  double max_direction_error_deg = 15.0;
};
std::vector<Parameter> Parameters(FailureBounds& bounds);

struct EstimatorSpec {
  std::string label;  // unique in the study; what tables and plots show
  std::string name;   // in the estimator registry
  RansacOptions options;
};

inline constexpr size_t kMaxConditions = 100'000;  // of a study

// One data setting and the values it takes; conditions are all combinations of all factors (full factorial).
struct Factor {
  std::string key;
  std::vector<std::string> levels;
};

// A simulation study: what is varied, what is compared, how often, from which seed.
struct Study {
  std::string name;
  std::string description;
  std::uint64_t seed = 1;
  int trials = 100;  // per condition; for a folder of pairs, passes over each pair
  Settings data;     // fixed settings, `scene` among them
  std::vector<Factor> factors;
  std::vector<EstimatorSpec> estimators;
  FailureBounds failure;
};

}  // namespace rcme
