#include "experiments/commands/tuning_source.h"

#include <fmt/format.h>

#include "experiments/commands/common_options.h"
#include "experiments/core/text/key_value.h"
#include "experiments/data/make_data.h"
#include "experiments/study/study_file.h"
#include "experiments/study/tuning_file.h"
#include "parameters/input_error.h"
#include "parameters/settings.h"

namespace rcme {

void AddTuningOptions(CLI::App* command, TuningArguments* arguments) {
  command
      ->add_option(
          "study", arguments->study,
          "study file (YAML) with a block `tune`, or the name of an installed one (`rcme list studies`)")
      ->required();
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command
      ->add_option(
          "--tune", arguments->overrides,
          "key=value of the block `tune`, repeatable: target=false_refusal, at_most=0.02, delta=0.1, "
          "calibrate=1000, ...")
      ->allow_extra_args(false);
  AddThreadsOption(command, &arguments->threads);
}

StudyPlan MakeTuningPlan(const TuningArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (!study.tuning) {
    throw InputError(
        fmt::format("{}: has no block 'tune' (estimator, target, options); see "
                    "the study tune_mu_lambda",
                    arguments.study));
  }
  if (study.repeats_per_scene > 1) {
    throw InputError(fmt::format(
        "{}: repeats_per_scene: tuning needs a new scene for every trial; leave it out", arguments.study));
  }
  if (study.common_scenes) {
    throw InputError(fmt::format(
        "{}: common_scenes: the guarantee needs conditions with scenes of their own; leave it out",
        arguments.study));
  }
  for (const std::string& text : arguments.overrides) {
    const KeyValue given = SplitKeyValue(text);
    FindParameter(Parameters(*study.tuning), given.key).SetFromText(given.value);
  }
  CheckCombinations(*study.tuning, study.estimators);  // of another estimator than in the file
  const bool is_simulated = FindSetting(study.data, "scene") != kMatchFilesScene;
  if (is_simulated) Override(&study, "severity", "skipped");  // no one looks at it here
  return MakePlan(study, arguments.study);
}

}  // namespace rcme
