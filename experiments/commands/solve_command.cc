#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/search/crossing_output.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct SolveArguments {
  std::string study, out, max_time, quantity = "failure", scale = "linear", format = "table";
  std::vector<std::string> estimators;
  StudyChanges changes;
  CrossingQuestion question;
  int threads = 0;
};

// The range of the study's own levels where none is given.
void SetRange(const Study& study, const CLI::Option& from, const CLI::Option& to,
              CrossingQuestion* question) {
  const auto factor = std::ranges::find(study.factors, question->setting, &Factor::key);
  std::vector<double> levels;
  if (factor != study.factors.end()) {
    for (const std::string& level : factor->levels) {
      double value = 0.0;
      if (ParseReal(level, &value)) levels.push_back(value);
    }
  }
  if (levels.empty() && (from.empty() || to.empty()))
    throw InputError(fmt::format(
        "solve: '{}' is no factor of the study with levels that are numbers; give --from and --to",
        question->setting));
  if (from.empty()) question->from = std::ranges::min(levels);
  if (to.empty()) question->to = std::ranges::max(levels);
  if (!(question->from < question->to))
    throw InputError(fmt::format("solve: --from {} is not below --to {}", question->from, question->to));
  if (question->is_logarithmic && question->from <= 0.0)
    throw InputError(fmt::format("solve: --scale log needs --from above 0, not {}", question->from));
}

void KeepEstimators(const std::vector<std::string>& labels, Study* study) {
  if (labels.empty()) return;
  for (const std::string& label : labels) FindEstimator(study->estimators, label, "--estimators: the study");
  std::erase_if(study->estimators,
                [&](const EstimatorSpec& spec) { return std::ranges::count(labels, spec.label) == 0; });
}

void Solve(SolveArguments arguments, const CLI::Option& from, const CLI::Option& to) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  KeepEstimators(arguments.estimators, &study);
  CrossingQuestion& question = arguments.question;
  question.is_logarithmic = arguments.scale == "log";
  question.event = *std::ranges::find(TrialEvents(), arguments.quantity, &TrialEvent::name);
  SetRange(study, from, to, &question);
  study = KeepEstimatorsWithSetting(study, question);
  CheckProcessEstimators(study.estimators);
  std::optional<Runner> runner;
  std::optional<KeptSteps> steps;
  if (!arguments.out.empty()) {
    MakeResultFolder(arguments.out);
    runner = MakeRunner(PlanCrossings(study, question), FindCheckpointInFolder(arguments.out), 1);
    steps.emplace(&*runner);
  }
  const CrossingAnswer answer = FindCrossings(study, question, arguments.threads, steps ? &*steps : nullptr);
  const CommandResult result = MakeCrossingsResult(study, question, answer);
  PrintResult(result, arguments.format);
  if (arguments.out.empty()) return;
  WriteResultFiles(result, (std::filesystem::path(arguments.out) / "crossings").string());
  runner->RemoveCheckpoint();
}

}  // namespace

void AddSolveCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("solve", "Find the level of a setting at which a rate crosses a value");
  command->footer(
      R"(Finds, say, the outlier ratio at which an estimator begins to fail more often than once in
a hundred calls: for each estimator, and in each condition of the other factors.

A third of the trials search: they go where they tell most about the crossing. The rest
are fresh trials at 16 levels around it, on which two intervals rest. One supposes only
that the rate does not fall with the setting; it holds for any such curve. The other also
supposes a logistic curve near the crossing; it is several times narrower, and wrong for
steps and plateaus. Trials of one level are the same for all estimators.

A refusal is no failure. An estimator that refuses the hardest problems fails less often
there than before, so that the rate of failure falls again and what is supposed does not
hold; ask for --quantity failure_or_refusal then.

If the command is stopped or killed, run it again with --out: finished work is kept in
OUT/unfinished.part until the end.

Examples:
  rcme solve failure_vs_outliers --over outlier_ratio --at 0.1
  rcme solve failure_vs_outliers --over sigma_px --from 0.1 --to 10 --scale log --at 0.05
  rcme solve STUDY --over num_matches --from 10 --to 200 --falling --at 0.01 --out few
  rcme plot crossings few/crossings.json --x scene --out few/crossings)");
  auto arguments = std::make_shared<SolveArguments>();
  AddStudyArgument(command, &arguments->study);
  command
      ->add_option("--over", arguments->question.setting,
                   "the setting to vary, a number: any key that --set takes (data, failure bound, or an "
                   "option: then only of the estimators that have it)")
      ->required();
  CLI::Option* from =
      command
          ->add_option("--from", arguments->question.from, "least level; default: that of the study's factor")
          ->transform(NumberIn());
  CLI::Option* to =
      command
          ->add_option("--to", arguments->question.to, "greatest level; default: that of the study's factor")
          ->transform(NumberIn());
  command->add_option("--scale", arguments->scale, "linear (default) or log: how levels are spaced")
      ->check(MakeChoiceValidator({"linear", "log"}));
  command->add_option("--quantity", arguments->quantity, "event whose rate is meant; default: failure")
      ->check(MakeChoiceValidator(TrialEventNames()));
  command->add_option("--at", arguments->question.rate, "the rate")
      ->transform(NumberIn({1e-6, 1.0 - 1e-6}))
      ->capture_default_str();
  command->add_flag("--falling", arguments->question.is_falling, "the rate falls with the setting");
  AddEstimatorsOption(command, &arguments->estimators);
  command
      ->add_option("--trials", arguments->question.num_trials, "trials for each estimator in each condition")
      ->transform(WholeNumberIn(100, 100'000'000))
      ->capture_default_str();
  AddFormatOption(command, &arguments->format);
  command->add_option("-o,--out", arguments->out,
                      "folder for crossings.txt, .csv and .json, created if missing");
  AddTimeLimit(command, "batches of trials", &arguments->max_time);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments, from, to] { Solve(*arguments, *from, *to); });
}

}  // namespace rcme
