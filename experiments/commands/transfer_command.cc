#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/time_limit.h"
#include "experiments/commands/tuning_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/tuning/transfer_output.h"
#include "experiments/tuning/tuning_work.h"

namespace rcme {
namespace {

struct TransferArguments : TuningArguments {
  std::string out, by;
  ShardArguments shards;
};

void RunTransfer(const TransferArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  const StudyPlan plan = TuningPlanOf(arguments);
  if (arguments.shards.parts.empty()) CheckProcessEstimators(plan.study.estimators);
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  FamiliesOf(plan, arguments.by);  // refuses before any trial
  const TuningWork work = PlanTransferWork(plan);
  const bool is_part = !arguments.shards.shard.empty();
  if (!is_part && arguments.shards.parts.empty()) MakeResultFolder(arguments.out);
  Runner runner = MakeRunner(work.items, arguments.shards, arguments.out,
                             FindCheckpointInFolder(arguments.out), arguments.threads);
  if (is_part) {
    GetTuningShard(plan, settings, work, {}, &runner);
    return PrintPartIsDone(runner.shard(), arguments.out);
  }
  GetTuningResults(plan, settings, work, Unreached::kVerifyAll, &runner);
  PrintCosts(runner);
  const TransferResult result =
      MeasureTransfer(plan, settings, arguments.by, CountsIn(plan, settings, work, runner.results()));
  MakeResultFolder(arguments.out);
  const std::filesystem::path folder(arguments.out);
  const std::string table = TransferAsTable(plan, result), json = (folder / "transfer.json").string();
  WriteFileWhole((folder / "transfer.txt").string(), table);
  WriteFileWhole(json, TransferAsJson(plan, settings, result));
  fmt::print("{}", table);
  DrawFigures("transfer", {json, "--out", (folder / "transfer").string()});
  runner.RemoveCheckpoint();
}

}  // namespace

void AddTransferCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "transfer", "Tune on one family of scenes, verify on all others: does a threshold survive?");
  command->footer(
      "Every condition of the study is a family of its own, or all those with a level of --by in common. "
      "Each\n"
      "is tuned as `rcme tune` would, and what it is tuned to is measured on fresh trials of every family: "
      "a\n"
      "matrix, at the price of one tuning. A cell holds (its whole exact 95 % interval is within the "
      "target),\n"
      "is violated, or undecided.\n"
      "Stopped or killed, the same command goes on: what is done is kept in OUT/unfinished.part until the "
      "end.\n"
      "\n"
      "Examples:\n"
      "  rcme transfer studies/transfer_mu.yaml --out transfer\n"
      "  rcme transfer studies/tune_mu_lambda.yaml --by scene --out by_scene\n"
      "  rcme transfer STUDY --shard 3/64 --out parts/3.json         one of 64 machines' share of the "
      "trials\n"
      "  rcme transfer STUDY --merge parts/*.json --out transfer     all of them: the bytes of one machine");
  auto arguments = std::make_shared<TransferArguments>();
  AddTuningOptions(command, arguments.get());
  command->add_option("--by", arguments->by,
                      "factor whose levels are the families; default: every condition");
  command
      ->add_option(
          "-o,--out", arguments->out,
          "folder for transfer.txt, transfer.json and the figures; with --shard the file of the part")
      ->required();
  AddShardOptions(command, "trials", &arguments->shards);
  command->callback([arguments] { RunTransfer(*arguments); });
}

}  // namespace rcme
