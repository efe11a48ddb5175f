#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/tuning_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/study/estimator_file.h"
#include "experiments/tuning/tune_json.h"
#include "experiments/tuning/tune_output.h"
#include "experiments/tuning/tuning_work.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct TuneArguments : TuningArguments {
  std::string out, figures, format = "table";
  ShardArguments shards;
  std::vector<std::string> merged;  // parts of the first round
  int repeat = 0;
};

// Runs one shard's part of the first round, and of the second if the first is complete.
void RunPart(const TuneArguments& arguments, const StudyPlan& plan, const SettingPlan& settings,
             const TuningWork& work, Runner* runner) {
  const WorkResults merged = MergeParts(work.items, arguments.merged);
  const MissingItems missing = GetTuningShard(plan, settings, work, merged, runner);
  if (missing.num_items == 0) return PrintPartIsDone(runner->shard(), arguments.out);
  if (!arguments.merged.empty()) {
    PrintMessage("--merged: {} {}s of the first round are missing, of the shards {} of {}\n",
                 missing.num_items, work.items.item_name, ArrayText(missing.shards), merged.num_shards);
  }
  PrintMessage(
      "the first round of shard {} is done; next, when all shards are done: the same command with --merged "
      "PARTS\n",
      runner->shard().Text());
  throw EndWith{kTryAgain};
}

void WriteFigures(const std::string& folder, const std::string& json) {
  const std::string path = (std::filesystem::path(folder) / "tune.json").string();
  WriteFileWhole(path, json);
  PrintMessage("drawing the figures in {}\n", folder);
  DrawFigures("tune", {path, "--out", (std::filesystem::path(folder) / "tune").string()});
}

void WriteEstimator(const TuneArguments& arguments, const StudyPlan& plan, const SettingPlan& settings,
                    const TuneResult& result) {
  const std::string& path = arguments.out;
  EstimatorSpec spec = settings.settings[*result.choice.setting].spec;
  spec.label += "_tuned";
  auto provenance = DescribeProvenance(plan, result);
  if (!arguments.changes.overrides.empty()) {
    provenance.emplace_back("changed", fmt::format("{}", fmt::join(arguments.changes.overrides, ", ")));
  }
  WriteFileWhole(path, EstimatorFileText(spec, provenance));
  // With its own seed the study would repeat the trials on which the estimator was tuned.
  PrintMessage("{}: estimator {}; next: rcme run STUDY --seed {} --add-estimator {} --out run.sqlite\n", path,
               spec.label, plan.study.seed + 1, QuoteForShell(path));
}

// The checkpoint lies beside the file of the table; without such a file there is none.
void RunRepetitions(const TuneArguments& arguments, const StudyPlan& plan, const SettingPlan& settings) {
  const std::string& out = arguments.out;
  if (!out.empty()) CheckIsNoInput(out, {arguments.study});
  if (!out.empty()) CheckCanBeWritten(out);
  Runner runner = MakeRunner(PlanRepetitions(plan, arguments.repeat),
                             out.empty() ? "" : FindCheckpointBeside(out), arguments.threads);
  const CommandResult result = MakeRepetitionsResult(plan, settings, RepeatTuning(plan, settings, &runner));
  if (!out.empty()) WriteFileWhole(out, result.text);
  runner.RemoveCheckpoint();
  PrintResult(result, arguments.format);
}

void RunTune(const TuneArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  const StudyPlan plan = MakeTuningPlan(arguments);
  if (arguments.shards.parts.empty()) CheckProcessEstimators(plan.study.estimators);
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  if (arguments.repeat > 0) {
    RunRepetitions(arguments, plan, settings);
    return;
  }
  if (arguments.out.empty())
    throw InputError("tune: --out is missing; give the file for the tuned estimator");
  CheckIsNoInput(arguments.out, {arguments.study});
  CheckIsNoInput(arguments.out, arguments.shards.parts);
  const TuningWork work = PlanTuningWork(plan);
  const bool is_part = !arguments.shards.shard.empty();
  if (!is_part) CheckCanBeWritten(arguments.out);  // minutes before it is
  Runner runner = MakeRunner(work.items, arguments.shards, arguments.out, FindCheckpointBeside(arguments.out),
                             arguments.threads);
  if (is_part) return RunPart(arguments, plan, settings, work, &runner);
  if (!arguments.figures.empty()) MakeResultFolder(arguments.figures);
  const Unreached unreached = arguments.figures.empty() ? Unreached::kStop : Unreached::kVerifyAll;
  GetTuningResults(plan, settings, work, unreached, &runner);
  PrintCosts(runner);
  const TuneResult result = Tune(plan, settings, unreached, CountsIn(plan, settings, work, runner.results()));
  std::vector<EntropyRoc> rocs;
  if (!result.verified.empty()) rocs = ComputeRocs(plan, EntropiesIn(plan, work, runner.results()));
  const CommandResult report = {TuneAsTable(plan, result, rocs), MakeSettingTable(plan, settings, result),
                                TuneAsJson(plan, settings, result, rocs)};
  PrintResult(report, arguments.format);
  if (result.choice.setting) WriteEstimator(arguments, plan, settings, result);
  if (!arguments.figures.empty()) {
    WriteFigures(arguments.figures, report.json);
  }
  runner.RemoveCheckpoint();
  if (!result.choice.setting) throw InputError(fmt::format("{}: {}", arguments.study, result.choice.why));
}

}  // namespace

void AddTuneCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("tune", "Find thresholds of an estimator that meet a target, with a guarantee");
  command->footer(R"(The study's block `tune` names the estimator, its open options with their levels, and
the target:
  false_refusal     at most at_most of the trials that would be right if nothing were
                    refused are refused; then the least failure
  failure           at most at_most fail and at most max_refusal are refused; then the
                    least refusal
  accepted_failure  at most at_most of the answered trials fail and at most max_refusal
                    are refused; then the least refusal. An option
                    max_failure_probability limits the stated probability
  risk              the least cost_of_failure * failure + cost_of_refusal * refusal
Exploration trials propose settings. Calibration trials certify one of them by exact
binomial tests in a fixed order, so it violates the target with probability at most
delta. Verification trials, used for nothing else, give the printed rates, beside those
that the tuning promised. All settings are decided from the same scores, so more levels
of mu or lambda cost no further estimation. If no setting is certified, nothing is
written: the message names the nearest setting or the number of trials that would be
enough (exit code 2).

If the command is stopped (Ctrl-C, SIGTERM, --max-time) or killed, run it again: finished
work is kept in OUT.unfinished.part until the end.

On many machines each runs a share of the trials, in two rounds; the second needs the
choice of the first. The merged parts have the bytes of a single tuning
(docs/many_machines.md):

  rcme tune STUDY --shard 3/64 --out parts/3.json                         exit code 75
  rcme tune STUDY --shard 3/64 --out parts/3.json --merged parts/*.json   second round
  rcme tune STUDY --merge parts/*.json --out tuned.yaml

Examples:
  rcme tune tune_mu_lambda --out tuned.yaml --figures tuned
  rcme tune STUDY --out tuned.yaml --tune target=false_refusal --tune at_most=0.02
  rcme tune STUDY --repeat 200       checks the guarantee by 200 tunings with fresh seeds
  rcme run STUDY --seed 2 --add-estimator tuned.yaml --out run.sqlite   fresh trials
  rcme estimate matches.csv.gz --estimator-file tuned.yaml)");
  auto arguments = std::make_shared<TuneArguments>();
  AddTuningOptions(command, arguments.get());
  command->add_option(
      "-o,--out", arguments->out,
      "estimator file to write, for studies and `rcme estimate`; with --shard the file of the part, "
      "with --repeat a file for the table");
  CLI::Option* figures =
      command->add_option("--figures", arguments->figures,
                          "folder for tune.json and the figures: surface, Pareto front, ROC of psi");
  AddFormatOption(command, &arguments->format);
  const ShardOptions shards = AddShardOptions(command, "trials", &arguments->shards);
  shards.shard->excludes(figures);
  command
      ->add_option("--merged", arguments->merged,
                   "files of all shards after the first round, for the second round of --shard")
      ->needs(shards.shard);
  command
      ->add_option("--repeat", arguments->repeat,
                   "tune this many times with fresh seeds and count how often the target is violated; "
                   "finished work is kept beside --out, if that is given")
      ->transform(WholeNumberIn(1, 100'000))
      ->excludes(figures)
      ->excludes(shards.shard)
      ->excludes(shards.merge);
  command->callback([arguments] { RunTune(*arguments); });
}

}  // namespace rcme
