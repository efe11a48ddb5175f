#include "experiments/study/estimator_spec.h"

#include "estimator/estimator_registry.h"

namespace rcme {

EstimatorSpec DefaultEstimator(const std::string& name) {
  EstimatorSpec spec{name, name, {}};
  SetOptions(&spec, {});
  return spec;
}

void SetOptions(EstimatorSpec* spec, const Settings& options) {
  const std::unique_ptr<EstimatorModel> model = Configure(*spec);
  const std::vector<Parameter> parameters = model->Parameters();
  for (const auto& [option, value] : options) {
    FindOption(spec->name, parameters, option).SetFromText(value);
  }
  spec->options = ValuesOf(parameters);
}

std::unique_ptr<EstimatorModel> Configure(const EstimatorSpec& spec) {
  return ConfigureEstimator(spec.name, spec.options);
}

std::unique_ptr<MotionEstimator> Make(const EstimatorSpec& spec) { return Configure(spec)->Make(); }

}  // namespace rcme
