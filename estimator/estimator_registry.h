#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/estimator_model.h"
#include "parameters/settings.h"

namespace rcme {

// One estimator of the registry. Studies, `rcme list` and the contract tests all read this table.
struct EstimatorEntry {
  std::string name;
  std::string doc;
  std::function<std::unique_ptr<EstimatorModel>()> make;  // with default options
  bool is_peer = false;    // another library's: `rcme audit` runs it only if a study names it
  bool is_audited = true;  // for the project's own: `rcme audit` runs it by default
  // Whether its last fit weighs matches by MotionProblem::noise_scale; the robust covariance then does so
  // too. No search uses the noise scale.
  bool uses_noise_scale = false;
  // Whether it also takes the options of the robust covariance and of the gate of model choice.
  bool takes_common_options = true;
};
const std::vector<EstimatorEntry>& EstimatorRegistry();

// Adds a user-defined estimator to the table. If its entry takes the common options, it gets the robust
// covariance (robust_covariance/covariance_option.h) and the gate of model choice (model_choice/gate.h). Call
// this before anything reads the registry, from one thread. Throws InputError if its name is empty or taken,
// or if one of its options has an empty or duplicate name, a name with `.` or `=` (not possible on a command
// line), or a default outside of its range.
void AddEstimator(EstimatorEntry entry);

// The entry called `name`. Throws InputError that lists the known names if there is none.
const EstimatorEntry& FindEstimator(const std::string& name);

// The option `name` of an estimator; `options` are its model's Parameters(). Throws InputError that lists the
// options if there is no such option.
const Parameter& FindOption(const std::string& estimator, const std::vector<Parameter>& options,
                            const std::string& name);

// The estimator called `name` with these options, the others at their defaults. Both throw InputError for an
// unknown estimator, an unknown option or a value that is not allowed; MakeEstimator also if two options
// contradict each other.
std::unique_ptr<EstimatorModel> ConfigureEstimator(const std::string& name, const Settings& options);
std::unique_ptr<MotionEstimator> MakeEstimator(const std::string& name, const Settings& options = {});

}  // namespace rcme
