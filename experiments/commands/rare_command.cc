#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/rare/rare_output.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct RareArguments {
  std::string study, out, max_time, method = "splitting", format = "table";
  StudyChanges changes;
  RareEffort splitting;
  StratifiedEffort stratified;
  int threads = 0;
};

void RequireEventOfMethod(const RareArguments& arguments) {
  if (arguments.method == "splitting" || arguments.splitting.event.kind == RareEvent::Kind::kFailure) return;
  throw InputError(fmt::format("--event {}: of --method stratified only failure is allowed",
                               Name(arguments.splitting.event.kind)));
}

void RunRare(const RareArguments& arguments) {
  RequireEventOfMethod(arguments);
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const bool is_splitting = arguments.method == "splitting";
  const StudyPlan plan = MakePlan(LoadChangedStudy(arguments.study, arguments.changes), arguments.study);
  CheckProcessEstimators(plan.study.estimators);
  MakeResultFolder(arguments.out);
  Runner runner =
      Runner::WithCheckpoint(is_splitting ? PlanSplitting(plan, plan.study.seed, arguments.splitting)
                                          : PlanStrata(plan, arguments.stratified),
                             FindCheckpointInFolder(arguments.out), arguments.threads);
  const CommandResult result =
      is_splitting ? MakeRareResult(plan, arguments.splitting,
                                    SplitFailures(plan, plan.study.seed, arguments.splitting, &runner))
                   : MakeStratifiedResult(plan, arguments.stratified,
                                          StratifyFailures(plan, arguments.stratified, &runner));
  WriteResultFiles(result, (std::filesystem::path(arguments.out) / "rare").string());
  runner.RemoveCheckpoint();
  PrintResult(result, arguments.format);
}

void AddEventOptions(CLI::App* command, RareEvent* event) {
  std::vector<std::pair<std::string, RareEvent::Kind>> kinds;
  for (const auto kind : {RareEvent::Kind::kFailure, RareEvent::Kind::kMisleadingRotation,
                          RareEvent::Kind::kMisleadingDirection})
    kinds.emplace_back(Name(kind), kind);
  CLI::Option* kind_option =
      command
          ->add_option_function<std::string>(
              "--event",
              [event, kinds](const std::string& name) {
                for (const auto& [known, kind] : kinds)
                  if (known == name) event->kind = kind;
              },
              "splitting: what is counted, failure (default), or an error beyond its protection level")
          ->check(MakeChoiceValidator({"failure", "misleading_rotation", "misleading_direction"}));
  command->add_option("--risk", event->risk, "of the protection levels (docs/integrity.md)")
      ->needs(kind_option)
      ->transform(NumberIn({1e-9, 0.5}))
      ->capture_default_str();
}

}  // namespace

void AddRareCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("rare", "Estimate failure rates too small to count");
  command->footer(R"(Estimates how often each estimator fails in each condition of a study, where plain
trials would take too many calls. Two methods:
  splitting   for failures whose error grows gradually with noise and geometry; down to
              1e-7 and below. A Markov chain moves scene, noise, outliers and samples of
              a trial from level to level of the error over its bound. Independent
              replicates give the interval. Needs noise: gaussian. It cannot see sudden
              failures without levels before them (a wrong mode); `unseen up to` is the
              largest rate of these that it could have missed
  stratified  for any failure and noise. Plain trials: all of those with a hard scene
              (Cramer-Rao bound) and one in 2, 4, ..., 64 of the others. Pays off if
              calls are slow and hard scenes have most of the failures
With --event misleading_rotation or misleading_direction splitting counts errors beyond
the protection level that the answer states, as `rcme integrity` does of plain trials.
If the number of outliers drives the failures, use `rcme run` with tilted_to. A rate that
cannot be trusted is marked, with the reason. If the command is stopped or killed, run it
again: finished work is kept in OUT/unfinished.part.

Examples:
  rcme rare rare_noise --out rare
  rcme rare STUDY --set sigma_px=0.25 --replicates 40 --out rare
  rcme rare STUDY --event misleading_direction --risk 1e-5 --out misleading
  rcme rare STUDY --method stratified --trials 1000000 --out strata)");
  auto arguments = std::make_shared<RareArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option("-o,--out", arguments->out, "folder for rare.txt, .csv and .json, created if missing")
      ->required();
  AddFormatOption(command, &arguments->format);
  AddTimeLimit(command, "replicates, or blocks of trials", &arguments->max_time);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command->add_option("--method", arguments->method, "splitting (default) or stratified")
      ->check(MakeChoiceValidator({"splitting", "stratified"}));
  AddEventOptions(command, &arguments->splitting.event);
  command
      ->add_option("--trials", arguments->stratified.num_trials,
                   "stratified: trials drawn per condition (default: 100000)")
      ->transform(WholeNumberIn(1000, 100'000'000));
  command
      ->add_option("--run-share", arguments->stratified.run_share,
                   "stratified: share of these to run (default: 0.1)")
      ->transform(NumberIn({0.02, 1.0}));
  command
      ->add_option("--particles", arguments->splitting.splitting.num_particles,
                   "splitting: particles of a replicate (default: 200)")
      ->transform(WholeNumberIn(10, 1'000'000));
  command
      ->add_option("--replicates", arguments->splitting.num_replicates,
                   "splitting: independent estimates (default: 20)")
      ->transform(WholeNumberIn(4, 100'000));
  command
      ->add_option("--moves", arguments->splitting.splitting.num_moves,
                   "splitting: moves of each particle at each level (default: 10)")
      ->transform(WholeNumberIn(1, 100'000));
  command
      ->add_option("--kept-share", arguments->splitting.splitting.kept_share,
                   "splitting: share of the particles beyond each level (default: 0.2)")
      ->transform(NumberIn({0.02, 0.9}));
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { RunRare(*arguments); });
}

}  // namespace rcme
