#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimator/estimator_model.h"
#include "parameters/settings.h"

namespace rcme {

// One line per estimator; everything that offers estimators (studies, `rcme list`, contract tests) reads this
// table.
struct EstimatorEntry {
  std::string name;
  std::string doc;
  std::function<std::unique_ptr<EstimatorModel>()> make;  // with default options
  bool is_peer = false;    // another library's: `rcme audit` asks it nothing unless a study names it
  bool is_audited = true;  // of the project's own: whether `rcme audit` asks it without a study that names it
  // Whether its last fit weighs matches by how noisy they are said to be (MotionProblem::noise_scale), and so
  // what the robust covariance is of. No search does.
  bool uses_noise_scale = false;
  // Whether it gets the options of the robust covariance and of the gate of model choice beside its own.
  bool takes_common_options = true;
  // Whether it uses what is known of the motion beside the matches (MotionProblem::prior).
  bool uses_motion_prior = false;
};
const std::vector<EstimatorEntry>& EstimatorRegistry();

// Adds a user-defined estimator to the table, with the robust covariance and behind the gate of model choice
// as all are that take them (robust_covariance/covariance_option.h, model_choice/gate.h); to be called before
// anything reads it, from one thread. Throws InputError if its name is taken or empty, or if an option of it
// has no name, a name that another has, a name that a command line cannot take (`.`, `=`), or a default that
// is not allowed.
void AddEstimator(EstimatorEntry entry);

// The entry called `name`; throws InputError that lists the known names.
const EstimatorEntry& FindEstimator(const std::string& name);

// The option of an estimator; `options` are its model's Parameters(). Throws InputError that lists those it
// has.
const Parameter& FindOption(const std::string& estimator, const std::vector<Parameter>& options,
                            const std::string& name);

// The estimator called `name` with these options, the others at their defaults. Throws InputError: an unknown
// estimator, an option it does not have, a value that is not allowed; MakeEstimator also where two options
// contradict each other.
std::unique_ptr<EstimatorModel> ConfigureEstimator(const std::string& name, const Settings& options);
std::unique_ptr<MotionEstimator> MakeEstimator(const std::string& name, const Settings& options = {});

}  // namespace rcme
