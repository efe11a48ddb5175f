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
      ->add_option(
          "--set", choice->overrides,
          "option=value of the estimator, repeatable, after those of --estimator-file; see `rcme list "
          "options`")
      ->allow_extra_args(false);
}

EstimatorSpec ChosenEstimator(const EstimatorChoice& choice) {
  EstimatorSpec spec = choice.file ? LoadEstimatorFile(*choice.file) : DefaultEstimator(choice.name);
  Settings options;
  for (const std::string& text : choice.overrides) {
    const size_t equals = std::min(text.find('='), text.size());
    const std::string value = equals < text.size() ? text.substr(equals + 1) : "";
    options.emplace_back(text.substr(0, equals), value);
  }
  SetOptions(&spec, options);
  return spec;
}

}  // namespace rcme
