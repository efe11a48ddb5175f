#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "estimator/ransac_options.h"

namespace rcme {

// One line per estimator; everything that offers estimators (studies, `rcme list`, contract tests) reads this
// table.
struct EstimatorEntry {
  std::string name;
  std::string doc;
  std::function<std::unique_ptr<MotionEstimator>(const RansacOptions&)> make;
};
const std::vector<EstimatorEntry>& EstimatorRegistry();

// Adds a user-defined estimator to the table; to be called before anything reads it, from one thread. Throws
// InputError if the name is taken or empty.
void AddEstimator(EstimatorEntry entry);

// The entry called `name`; throws InputError that lists the known names.
const EstimatorEntry& FindEstimator(const std::string& name);

}  // namespace rcme
