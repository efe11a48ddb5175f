#include "experiments/commands/estimator_source.h"

#include <algorithm>

#include "experiments/study/estimator_file.h"

namespace rcme {

void AddEstimatorOptions(CLI::App* command, CLI::Option* name, EstimatorChoice* choice) {
  command
      ->add_option("--estimator-file", choice->file,
                   "estimator file: name and options from there, in place of a name")
      ->excludes(name);
  command
      ->add_option("--set", choice->overrides,
                   "option=value, repeatable, after those of --estimator-file; see `rcme list options`")
      ->allow_extra_args(false);
}

EstimatorSpec ChosenEstimator(const EstimatorChoice& choice) {
  EstimatorSpec spec =
      choice.file ? LoadEstimatorFile(*choice.file) : EstimatorSpec{choice.name, choice.name, {}};
  for (const std::string& text : choice.overrides) {
    const size_t equals = std::min(text.find('='), text.size());
    const std::string value = equals < text.size() ? text.substr(equals + 1) : "";
    FindParameter(Parameters(spec.options), text.substr(0, equals)).SetFromText(value);
  }
  return spec;
}

}  // namespace rcme
