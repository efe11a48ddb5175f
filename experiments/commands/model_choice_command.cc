
#include <filesystem>
#include <memory>

#include "experiments/audit/model_choice/choice_output.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"

namespace rcme {
namespace {

struct ModelChoiceArguments {
  std::string study, out, max_time, format = "table";
  StudyChanges changes;
  std::vector<std::string> by;
  int trials = 0;  // 0: the study's own
  int threads = 0;
};

void RunModelChoice(const ModelChoiceArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (arguments.trials > 0) study.trials = arguments.trials;
  const StudyPlan plan = MakePlan(study, arguments.study, PlanEstimators::kNotMade);
  MakeResultFolder(arguments.out);
  Runner runner =
      Runner::WithCheckpoint(PlanChoices(plan), FindCheckpointInFolder(arguments.out), arguments.threads);
  const CommandResult result = MakeChoiceResult(plan, CountChoices(plan, arguments.by, &runner));
  WriteResultFiles(result, (std::filesystem::path(arguments.out) / "model_choice").string());
  runner.RemoveCheckpoint();
  PrintResult(result, arguments.format);
}

}  // namespace

void AddModelChoiceCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "model-choice", "Test whether model-choice criteria recognise planes, rotations and low parallax");
  command->footer(R"(Every criterion (a value of the option model_choice) gives a verdict on every trial of
a study, and the verdict is compared with the exact scene. The result is a confusion
matrix per criterion with a row per truth. The study's estimators are not run. The
truth of a trial:
  rotation_only        the baseline is zero
  too_little_parallax  at most 5 % of the right matches show more parallax than the
                       noise of a rotation
  planar               one homography maps at least 95 % of the exact points to within
                       sqrt(2) sigma
  general              no homography does so for more than 75 % of them
  borderline           between these, with parallax of 5 to 20 %, or fewer than eight
                       right matches
If the command is stopped or killed, run it again: finished work is kept in
OUT/unfinished.part.

Examples:
  rcme model-choice model_choice --out choice
  rcme model-choice model_choice --by outlier_ratio --out choice
  rcme plot heat_map choice/model_choice.csv --x verdict --y truth --quantities share \
      --where outlier_ratio=0.2 --out matrix)");
  auto arguments = std::make_shared<ModelChoiceArguments>();
  AddStudyArgument(command, &arguments->study);
  command
      ->add_option("-o,--out", arguments->out,
                   "folder for model_choice.txt, .csv and .json, created if missing")
      ->required();
  AddFormatOption(command, &arguments->format);
  command
      ->add_option("--by", arguments->by,
                   "factor, repeatable: a matrix for each of its levels; default: one matrix for all")
      ->allow_extra_args(false);
  command->add_option("--trials", arguments->trials, "trials per condition; default: the study's")
      ->transform(WholeNumberIn(1, 100'000'000));
  AddTimeLimit(command, "blocks of trials", &arguments->max_time);
  AddStudyOptions(command, &arguments->changes);
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { RunModelChoice(*arguments); });
}

}  // namespace rcme
