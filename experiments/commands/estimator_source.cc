#include "experiments/commands/estimator_source.h"

#include <algorithm>

#include "estimator/estimator_registry.h"
#include "experiments/core/files/shared_files.h"
#include "experiments/commands/process_option.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_file.h"

namespace rcme {

void AddEstimatorOptions(CLI::App* command, CLI::Option* name, EstimatorChoice* choice) {
  command
      ->add_option("--estimator-file", choice->file,
                   "estimator file with name and options, or the name of an installed one (`rcme list "
                   "estimator_files`)")
      ->excludes(name);
  command
      ->add_option(
          "--set", choice->overrides,
          "option=value of the estimator, repeatable; overrides --estimator-file; see `rcme list options`")
      ->allow_extra_args(false);
  AddProcessOption(command, &choice->allow_process);
}

namespace {

// Whether only a file that comes with the program has this name.
bool IsNameOfFile(const std::string& name) {
  if (std::ranges::count(EstimatorRegistry(), name, &EstimatorEntry::name) > 0) return false;
  const std::vector<std::string> files = NamesIn(SharedFolder::kEstimators);
  return std::ranges::count(files, name) > 0;
}

}  // namespace

EstimatorSpec ChosenEstimator(const EstimatorChoice& choice) {
  EstimatorSpec spec = choice.file                 ? LoadEstimatorFile(*choice.file)
                       : IsNameOfFile(choice.name) ? LoadEstimatorFile(choice.name)
                                                   : DefaultEstimator(choice.name);
  Settings options;
  for (const std::string& text : choice.overrides) {
    const size_t equals = std::min(text.find('='), text.size());
    const std::string value = equals < text.size() ? text.substr(equals + 1) : "";
    options.emplace_back(text.substr(0, equals), value);
  }
  SetOwnOptions(&spec, options);
  std::vector<EstimatorSpec> chosen = {std::move(spec)};
  if (choice.allow_process) AllowAndSay(&chosen);
  RequireAllowedCommands(chosen);  // now, not after the pairs have been read
  return chosen.front();
}

}  // namespace rcme
