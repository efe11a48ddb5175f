
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/real/paper_table/paper_table_output.h"

namespace rcme {
namespace {

struct PaperTableArguments {
  std::string run, out;
  std::vector<std::string> groups;  // empty: the usual ones
  std::string clusters = "images", format = "table";
  std::vector<double> bounds_deg;
};

void RunPaperTable(const PaperTableArguments& arguments) {
  std::vector<SceneGroup> groups;
  for (const std::string& text : arguments.groups) groups.push_back(ParseSceneGroup(text));
  const PaperTable table =
      MakePaperTable(ResultStore::OpenForReading(arguments.run), groups.empty() ? UsualSceneGroups() : groups,
                     arguments.clusters == "images" ? TableClusters::kImages : TableClusters::kSequences,
                     arguments.bounds_deg);
  const CommandResult result = MakePaperResult(table);
  if (!arguments.out.empty()) {
    MakeResultFolder(arguments.out);
    WriteResultFiles(result, (std::filesystem::path(arguments.out) / "paper_table").string());
  }
  PrintResult(result, arguments.format);
}

}  // namespace

void AddPaperTableCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "paper-table", "Print the paper's table for your own pairs: Detect-fail and Failure per sequence");
  command->footer(R"(Reads a run over a folder of match files. For each scene, group of scenes and estimator
it counts Detect-fail and other refusals, failures by the paper's flag
(n*_I / n_I <= kappa), failures by ground truth where the files state it, and how often
the flag is right. Pairs that share an image are not independent: the intervals are
exact binomial ones for the number of independent pairs with the same information. Pairs
whose truth is in doubt (truth_in_doubt of the study) are counted apart. The paper's
printed figures follow, with intervals.

Examples:
  rcme run paper_table --set folder=PAIRS --out run.sqlite
  rcme paper-table run.sqlite --out table
  rcme paper-table run.sqlite --bound 5 --bound 10      outcomes at 5 and at 10 degrees
  rcme paper-table run.sqlite --group indoor='MH_*,V1_*,office' --group outdoor='kitti*')");
  auto arguments = std::make_shared<PaperTableArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("-o,--out", arguments->out,
                      "folder for paper_table.txt, .csv and .json, created if missing");
  command
      ->add_option(
          "--group", arguments->groups,
          "NAME=SCENE,SCENE,..., repeatable: scenes to count together (names, or prefixes with a star); "
          "default: indoor and outdoor, by the names of KITTI, EuRoC, HRBB4 and TUM sequences")
      ->allow_extra_args(false);
  command
      ->add_option("--clusters", arguments->clusters,
                   "which pairs are dependent: those that share images, or all of a sequence")
      ->check(MakeChoiceValidator({"images", "sequences"}))
      ->capture_default_str();
  command
      ->add_option("--bound", arguments->bounds_deg,
                   "DEG, repeatable: also refusals, failures and successes side by side, a failure being an "
                   "error of rotation or direction above DEG, with the AUC up to it and the median time")
      ->transform(NumberIn({1e-6, 180.0}))
      ->allow_extra_args(false);
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { RunPaperTable(*arguments); });
}

}  // namespace rcme
