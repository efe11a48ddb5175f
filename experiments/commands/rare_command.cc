#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/process_option.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/commands/time_limit.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/rare/rare_output.h"

namespace rcme {
namespace {

struct RareArguments {
  std::string study, out, max_time, method = "splitting";
  StudyChanges changes;
  RareEffort splitting;
  StratifiedEffort stratified;
  int threads = 0;
};

struct RareTexts {
  std::string table, csv, json;
};

RareTexts Split(const StudyPlan& plan, const RareArguments& arguments, Runner* runner) {
  const std::vector<RareCell> cells = SplitFailures(plan, plan.study.seed, arguments.splitting, runner);
  std::vector<RareRow> rows;
  for (const RareCell& cell : cells) rows.push_back(RowOf(cell));
  return {RareAsTable(plan, cells), RareAsCsv(plan, rows), RareAsJson(plan, arguments.splitting, cells)};
}

RareTexts Stratify(const StudyPlan& plan, const RareArguments& arguments, Runner* runner) {
  const std::vector<StratifiedCell> cells = StratifyFailures(plan, arguments.stratified, runner);
  std::vector<RareRow> rows;
  for (const StratifiedCell& cell : cells) rows.push_back(RowOf(cell));
  return {StratifiedAsTable(plan, cells), RareAsCsv(plan, rows),
          StratifiedAsJson(plan, arguments.stratified, cells)};
}

void RunRare(const RareArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const bool is_splitting = arguments.method == "splitting";
  const StudyPlan plan = PlanOf(LoadChangedStudy(arguments.study, arguments.changes), arguments.study);
  CheckProcessEstimators(plan.study.estimators);
  MakeResultFolder(arguments.out);
  Runner runner =
      Runner::WithCheckpoint(is_splitting ? PlanSplitting(plan, plan.study.seed, arguments.splitting)
                                          : PlanStrata(plan, arguments.stratified),
                             FindCheckpointInFolder(arguments.out), arguments.threads);
  const RareTexts texts = is_splitting ? Split(plan, arguments, &runner) : Stratify(plan, arguments, &runner);
  const std::filesystem::path folder(arguments.out);
  WriteFileWhole((folder / "rare.txt").string(), texts.table);
  WriteFileWhole((folder / "rare.csv").string(), texts.csv);
  WriteFileWhole((folder / "rare.json").string(), texts.json);
  runner.RemoveCheckpoint();
  fmt::print("{}", texts.table);
}

}  // namespace

void AddRareCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("rare", "Failure rates far below what can be counted: splitting, or strata");
  command->footer(
      "How often each estimator fails in each condition of a study where plain trials would take too many.\n"
      "  splitting   down to 1e-7 and below, where noise and geometry make errors grow by degrees: scene, "
      "noise,\n"
      "              outliers and samples of a trial are moved by a Markov chain from level to level of the "
      "error\n"
      "              over its bound; independent replicates give the interval. Needs noise: gaussian. "
      "Failures\n"
      "              that come at once, with no level before them (a wrong mode), are beyond it: `unseen up "
      "to`\n"
      "              says which rate of them would be missed\n"
      "  stratified  plain trials, of which those with a hard scene (Cramer-Rao bound) are run and of the "
      "others\n"
      "              one in 2, 4, ..., 64: for any failure and noise; pays where calls are slow and hard "
      "scenes\n"
      "              hold the failures\n"
      "Where the number of outliers drives failures: `rcme run` with tilted_to. A rate that cannot be "
      "trusted says\n"
      "so and why. Stopped or killed, the same command goes on: what is done is kept in "
      "OUT/unfinished.part.\n"
      "\n"
      "Examples:\n"
      "  rcme rare studies/rare_noise.yaml --out rare\n"
      "  rcme rare STUDY --set sigma_px=0.25 --replicates 40 --out rare\n"
      "  rcme rare STUDY --method stratified --trials 1000000 --out strata");
  auto arguments = std::make_shared<RareArguments>();
  command
      ->add_option("study", arguments->study,
                   "study file (YAML), or the name of one that comes with the program")
      ->required();
  command
      ->add_option("-o,--out", arguments->out, "folder for rare.txt, .csv and .json; made if it is missing")
      ->required();
  AddTimeLimit(command, "replicates, or blocks of trials", &arguments->max_time);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  command->add_option("--method", arguments->method, "splitting (default) or stratified")
      ->check(OneOf({"splitting", "stratified"}));
  command
      ->add_option("--trials", arguments->stratified.num_trials,
                   "stratified: trials drawn per condition (default: 100000)")
      ->transform(WholeNumberIn(1000, 100'000'000));
  command
      ->add_option("--run-share", arguments->stratified.run_share,
                   "stratified: share of them to be run (default: 0.1)")
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
  command
      ->add_option("--threads", arguments->threads,
                   "threads; 0: one per core. The results do not depend on it")
      ->transform(WholeNumberIn(0, 1024));
  command->callback([arguments] { RunRare(*arguments); });
}

}  // namespace rcme
