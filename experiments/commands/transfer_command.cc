#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/base/file_output.h"
#include "experiments/base/stop_request.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/tuning_source.h"
#include "experiments/tuning/transfer_output.h"

namespace rcme {
namespace {

struct TransferArguments : TuningArguments {
  std::string out, by;
};

void RunTransfer(const TransferArguments& arguments) {
  const StopOnSignals stop;
  const StudyPlan plan = TuningPlanOf(arguments);
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  MakeResultFolder(arguments.out);
  const TransferResult result = MeasureTransfer(plan, settings, arguments.by, arguments.threads);
  const std::filesystem::path folder(arguments.out);
  const std::string table = TransferAsTable(plan, result), json = (folder / "transfer.json").string();
  WriteFileWhole((folder / "transfer.txt").string(), table);
  WriteFileWhole(json, TransferAsJson(plan, settings, result));
  fmt::print("{}", table);
  DrawFigures("transfer", {json, "--out", (folder / "transfer").string()});
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
      "\n"
      "Examples:\n"
      "  rcme transfer experiments/studies/transfer_mu.yaml --out transfer\n"
      "  rcme transfer experiments/studies/tune_mu_lambda.yaml --by scene --out by_scene");
  auto arguments = std::make_shared<TransferArguments>();
  AddTuningOptions(command, arguments.get());
  command->add_option("--by", arguments->by,
                      "factor whose levels are the families; default: every condition");
  command->add_option("-o,--out", arguments->out, "folder for transfer.txt, transfer.json and the figures")
      ->required();
  command->callback([arguments] { RunTransfer(*arguments); });
}

}  // namespace rcme
