
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/shard_options.h"
#include "experiments/commands/tuning_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/tuning/transfer_output.h"
#include "experiments/tuning/tuning_work.h"

namespace rcme {
namespace {

struct TransferArguments : TuningArguments {
  std::string out, by, format = "table";
  ShardArguments shards;
};

void RunTransfer(const TransferArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  const StudyPlan plan = MakeTuningPlan(arguments);
  if (arguments.shards.parts.empty()) CheckProcessEstimators(plan.study.estimators);
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  ListFamilies(plan, arguments.by);  // refuses before any trial
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
  const CommandResult report = MakeTransferResult(plan, settings, result);
  const std::string json = (folder / "transfer.json").string();
  WriteFileWhole((folder / "transfer.txt").string(), report.text);
  WriteFileWhole(json, report.json);
  PrintResult(report, arguments.format);
  DrawFigures("transfer", {json, "--out", (folder / "transfer").string()});
  runner.RemoveCheckpoint();
}

}  // namespace

void AddTransferCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("transfer", "Tune on each family of scenes and verify the threshold on all others");
  command->footer(R"(Every condition of the study is a family; with --by, all conditions with the same level
are one family. Each family is tuned as by `rcme tune`, and the tuned setting is measured
on fresh trials of every family, at the cost of one tuning. The result is a matrix. A
cell holds if its whole exact 95 % interval meets the target; otherwise it is violated or
undecided.

If the command is stopped or killed, run it again: finished work is kept in
OUT/unfinished.part until the end.

Examples:
  rcme transfer transfer_mu --out transfer
  rcme transfer tune_mu_lambda --by scene --out by_scene
  rcme transfer STUDY --shard 3/64 --out parts/3.json       the share of one machine
  rcme transfer STUDY --merge parts/*.json --out transfer   the bytes of a single run)");
  auto arguments = std::make_shared<TransferArguments>();
  AddTuningOptions(command, arguments.get());
  command->add_option("--by", arguments->by,
                      "factor whose levels are the families; default: every condition is a family");
  command
      ->add_option(
          "-o,--out", arguments->out,
          "folder for transfer.txt, transfer.json and the figures; with --shard the file of the part")
      ->required();
  AddFormatOption(command, &arguments->format);
  AddShardOptions(command, "trials", &arguments->shards);
  command->callback([arguments] { RunTransfer(*arguments); });
}

}  // namespace rcme
