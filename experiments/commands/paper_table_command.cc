#include <fmt/format.h>

#include <filesystem>
#include <map>
#include <memory>

#include "experiments/core/files/file_output.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/twin_commands.h"
#include "experiments/real/paper_table/paper_table_output.h"

namespace rcme {
namespace {

struct PaperTableArguments {
  std::string run, out;
  std::vector<std::string> groups;  // empty: the usual ones
  std::string clusters = "images", format = "table";
};

void RunPaperTable(const PaperTableArguments& arguments) {
  std::vector<SceneGroup> groups;
  for (const std::string& text : arguments.groups) groups.push_back(ParseSceneGroup(text));
  const PaperTable table =
      MakePaperTable(ResultStore::OpenForReading(arguments.run), groups.empty() ? UsualSceneGroups() : groups,
                     arguments.clusters == "images" ? TableClusters::kImages : TableClusters::kSequences);
  const std::string text = PaperTableAsText(table), csv = PaperTableAsCsv(table),
                    json = PaperTableAsJson(table);
  if (!arguments.out.empty()) {
    MakeResultFolder(arguments.out);
    const std::filesystem::path folder(arguments.out);
    WriteFileWhole((folder / "paper_table.txt").string(), text);
    WriteFileWhole((folder / "paper_table.csv").string(), csv);
    WriteFileWhole((folder / "paper_table.json").string(), json);
  }
  fmt::print("{}", arguments.format == "json" ? json : arguments.format == "csv" ? csv : text);
}

}  // namespace

void AddPaperTableCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "paper-table", "The paper's table for pairs of one's own: Detect-fail and Failure per sequence");
  command->footer(
      "Of a run over a folder of match files (`rcme run studies/paper_table.yaml --set "
      "folder=PAIRS`):\n"
      "per scene and group of scenes, and for every estimator, Detect-fail and other refusals, failures by "
      "the\n"
      "paper's flag (n*_I / n_I <= kappa), failures by the truth where the files state one, and how often "
      "the\n"
      "flag is right. Pairs that share an image are not independent: intervals are exact binomial ones of "
      "as\n"
      "many independent pairs as would tell as much. The paper's printed figures follow with their own.\n"
      "\n"
      "Examples:\n"
      "  rcme run studies/paper_table.yaml --set folder=PAIRS --out run.sqlite\n"
      "  rcme paper-table run.sqlite --out table\n"
      "  rcme paper-table run.sqlite --group indoor='MH_*,V1_*,office' --group outdoor='kitti*'");
  auto arguments = std::make_shared<PaperTableArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command->add_option("-o,--out", arguments->out,
                      "folder for paper_table.txt, .csv and .json; made if it is missing");
  command
      ->add_option("--group", arguments->groups,
                   "NAME=SCENE,SCENE,..., repeatable: scenes (names, or beginnings with a star) to be "
                   "counted together; default: indoor and outdoor by the names of KITTI, EuRoC, HRBB4 and "
                   "TUM sequences")
      ->allow_extra_args(false);
  command
      ->add_option("--clusters", arguments->clusters,
                   "what makes pairs dependent: images that they share, or all of a sequence")
      ->check(OneOf({"images", "sequences"}))
      ->capture_default_str();
  command->add_option("--format", arguments->format, "table (for people), csv or json (for programs)")
      ->check(OneOf({"table", "csv", "json"}))
      ->capture_default_str();
  command->callback([arguments] { RunPaperTable(*arguments); });
}

}  // namespace rcme
