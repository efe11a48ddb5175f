#include "experiments/commands/estimator_source.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "estimator/conform/conform_estimator.h"
#include "estimator/estimator_registry.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/text/key_value.h"
#include "experiments/study/command_permission.h"
#include "experiments/study/estimator_entry.h"
#include "experiments/study/estimator_file.h"
#include "parameters/settings.h"

namespace rcme {

void AddEstimatorOptions(CLI::App* command, EstimatorChoice* choice) {
  AddEstimatorOptions(
      command,
      command->add_option("--estimator", choice->name, "see `rcme list estimators`")->capture_default_str(),
      choice);
}

void AddEstimatorOptions(CLI::App* command, CLI::Option* name, EstimatorChoice* choice) {
  command
      ->add_option("--estimator-file", choice->file,
                   "estimator file with name and options, or the name of an installed one (`rcme list "
                   "estimator_files`)")
      ->excludes(name);
  command
      ->add_option("--conform", choice->conform,
                   "the estimator of a file that `rcme conform` wrote, made to keep its word")
      ->excludes(name)
      ->excludes("--estimator-file");
  command
      ->add_option(
          "--set", choice->overrides,
          "option=value of the estimator, repeatable; overrides --estimator-file; see `rcme list options`")
      ->allow_extra_args(false);
  AddProcessOption(command, &choice->allow_process);
}

namespace {

// The estimator of a name: a built-in one, or an installed file by its name or its label.
EstimatorSpec NamedEstimator(const std::string& name) {
  if (IsNameOfEstimatorFile(name)) return LoadEstimatorFile(name);
  const bool is_built_in = std::ranges::count(EstimatorRegistry(), name, &EstimatorEntry::name) > 0;
  if (!is_built_in) {
    if (const std::optional<std::string> file = FindInstalledFile(name)) return LoadEstimatorFile(*file);
  }
  RequireEstimatorName(name);
  return DefaultEstimator(name);
}

}  // namespace

EstimatorSpec ChosenEstimator(const EstimatorChoice& choice) {
  EstimatorSpec spec = choice.conform ? DefaultEstimator(kConformEstimator)
                       : choice.file  ? LoadEstimatorFile(*choice.file)
                                      : NamedEstimator(choice.name);
  Settings options;
  if (choice.conform) options.emplace_back("file", *choice.conform);
  for (const std::string& text : choice.overrides) {
    const KeyValue given = SplitKeyValue(text);
    options.emplace_back(given.key, given.value);
  }
  SetOwnOptions(&spec, options);
  std::vector<EstimatorSpec> chosen = {std::move(spec)};
  if (choice.allow_process) AllowAndSay(&chosen);
  RequireAllowedCommands(chosen);  // now, not after the pairs have been read
  return chosen.front();
}

EstimatorSpec FindStudyEstimator(const Study& study, const std::string& name, bool allow_process) {
  const auto spec = std::ranges::find(study.estimators, name, &EstimatorSpec::label);
  if (spec != study.estimators.end()) return *spec;
  EstimatorChoice choice;
  choice.name = name;
  choice.allow_process = allow_process;
  if (std::filesystem::is_regular_file(name)) choice.file = name;
  return ChosenEstimator(choice);
}

EstimatorSpec FindOnlyEstimator(const Study& study, const std::string& command, const std::string& name,
                                bool allow_process) {
  if (!name.empty()) return FindStudyEstimator(study, name, allow_process);
  if (study.estimators.size() != 1)
    throw InputError(command + ": the study has several estimators; choose one with --estimator");
  return study.estimators.front();
}

bool HasRobustCovariance(const EstimatorSpec& spec) {
  return FindSetting(spec.options, "covariance") == "robust";
}

}  // namespace rcme
