#include "experiments/commands/estimator_run_options.h"

#include "experiments/commands/common_options.h"

namespace rcme {

CLI::Option* AddStudyAndEstimator(CLI::App* command, EstimatorRunArguments* arguments) {
  CLI::Option* study = command->add_option("study", arguments->study, "study file (YAML) or its name");
  command->add_option("--estimator", arguments->estimator,
                      "label of the study, estimator or estimator file; default: the study's only one");
  return study;
}

void AddTrialsOption(CLI::App* command, EstimatorRunArguments* arguments) {
  command->add_option("--trials", arguments->trials, "trials per condition, instead of the study's number")
      ->transform(WholeNumberIn(1, 100'000'000));
}

void AddRunOptions(CLI::App* command, EstimatorRunArguments* arguments) {
  AddStudyOptions(command, &arguments->changes);
  AddShardOptions(command, "trials", &arguments->shards);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddThreadsOption(command, &arguments->threads);
}

}  // namespace rcme
