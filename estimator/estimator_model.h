#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "parameters/parameter.h"

namespace rcme {

// The option that bounds the work of a call.
struct Effort {
  std::string option;         // integer option: number of samples or iterations
  bool has_own_rule = false;  // the estimator may stop before the bound
};

// The options of an estimator and its factory; an entry of the registry (estimator_registry.h) holds one.
// Configure it once, from one thread.
class EstimatorModel {
 public:
  virtual ~EstimatorModel() = default;
  // The options that have an effect on this estimator, each with name, default, range, unit and meaning. They
  // point into the model and are valid as long as it lives.
  virtual std::vector<Parameter> Parameters() { return {}; }
  // Sets every option that can make the estimator refuse a motion to a value at which it never refuses. `rcme
  // tune` uses this to find false refusals: good motions that only these options refuse.
  virtual void LiftLimits() {}
  // The option that bounds the work of a call, under the current options; nullopt if no option does.
  virtual std::optional<Effort> EffortOption() const { return std::nullopt; }
  // Makes the estimator with the current options. Throws InputError that names both options if two contradict
  // each other.
  virtual std::unique_ptr<MotionEstimator> Make() const = 0;
};

}  // namespace rcme
