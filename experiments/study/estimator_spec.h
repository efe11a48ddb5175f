#pragma once

#include <memory>
#include <string>

#include "estimator/estimator_model.h"
#include "parameters/settings.h"

namespace rcme {

// One estimator of a study. In a result file it may be one that this program does not know.
struct EstimatorSpec {
  std::string label;  // unique in the study; what tables and plots show
  std::string name;   // in the estimator registry
  Settings options;   // every option that the estimator has, with its value as the option itself writes it
};

// An estimator with its default options, labelled by its name. Throws InputError that lists the known names.
EstimatorSpec DefaultEstimator(const std::string& name);

// Gives options other values. Throws InputError that lists the options the estimator has, or what is allowed.
void SetOptions(EstimatorSpec* spec, const Settings& options);

// The estimator, configured or made. Throw InputError as ConfigureEstimator does.
std::unique_ptr<EstimatorModel> Configure(const EstimatorSpec& spec);
std::unique_ptr<MotionEstimator> Make(const EstimatorSpec& spec);

}  // namespace rcme
