#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimator.h"
#include "parameters/parameter.h"

namespace rcme {

// What limits the work of a call.
struct Effort {
  std::string option;         // a whole number: samples, iterations
  bool has_own_rule = false;  // the estimator may stop earlier by a rule of its own
};

// An estimator before it is made, with options of its own: what an entry of the registry brings
// (estimator_registry.h). Configured once, by one thread.
class EstimatorModel {
 public:
  virtual ~EstimatorModel() = default;
  // The options by name, each with its default, range and unit, and what it does; valid as long as the model
  // lives. Only those that have an effect on this estimator.
  virtual std::vector<Parameter> Parameters() { return {}; }
  // Gives the options that make the estimator refuse a motion it has a value at which they refuse none. What
  // is refused only because of them is a false refusal where the motion is good (rcme tune).
  virtual void LiftLimits() {}
  // With these options. Nothing: no option sets how much work a call does.
  virtual std::optional<Effort> EffortOption() const { return std::nullopt; }
  // The estimator with these options. Throws InputError that names two that contradict each other.
  virtual std::unique_ptr<MotionEstimator> Make() const = 0;
};

}  // namespace rcme
