#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/scratch_folder.h"
#include "experiments/core/files/yaml_input.h"
#include "experiments/core/table/read_csv_table.h"
#include "experiments/core/text/json_output.h"
#include "experiments/run/store/distinct_trials.h"
#include "experiments/statistics/surface_data.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kCandidatesPerProposal = 32, kLeastCandidates = 512, kMostCandidates = 2048;

struct SurfaceArguments {
  std::vector<std::string> runs;
  std::string quantity = "failure", estimator, out, format = "table";
  int num_proposed = 0;
  std::optional<double> level;
  bool has_no_figures = false;
};

MarginalQuantity FindQuantity(const std::string& name) {
  if (name == "failure") return MarginalQuantity::kFailure;
  if (name == "coverage") return MarginalQuantity::kSureCoverage;
  return MarginalQuantity::kFailedLessStated;
}

// Reads the tables that the script wrote: the held-out conditions, and other tables if there are any.
CommandResult ReadSurface(const std::string& folder) {
  const auto path = [&](const std::string& name) {
    return (std::filesystem::path(folder) / (name + ".csv")).string();
  };
  const auto read = [&](const std::string& name) {
    return ReadCsvTable(ReadInputText(path(name), {"table", "a table of `rcme surface`"}));
  };
  std::vector<NamedTable> others;
  for (const char* name : {"indices", "curves", "maps", "proposed"})
    if (std::filesystem::exists(path(name))) others.push_back({name, read(name)});
  return MakeResult("", kSurfaceFormat, {}, read("cross_validation"), others);
}

void MakeSurface(const SurfaceArguments& arguments) {
  RequireDistinctTrials(arguments.runs);
  SurfaceOptions options{arguments.estimator, FindQuantity(arguments.quantity), 0};
  if (arguments.num_proposed > 0)
    options.num_candidates =
        std::clamp(kCandidatesPerProposal * arguments.num_proposed, kLeastCandidates, kMostCandidates);
  const ScratchFolder folder;
  const std::string data = folder.path() + "/surface.json";
  WriteFileWhole(data, SurfaceDataAsJson(arguments.runs, options));
  std::vector<std::string> words = {data, "--out", arguments.out, "--propose",
                                    fmt::format("{}", arguments.num_proposed)};
  if (arguments.level) words.insert(words.end(), {"--level", fmt::format("{}", *arguments.level)});
  if (arguments.has_no_figures) words.push_back("--no-figures");
  const bool is_for_people = arguments.format == "table";
  const ScriptEnd end =
      RunPlotScript("surface_report", words, is_for_people ? ScriptOutput::kShown : ScriptOutput::kDropped);
  if (end == ScriptEnd::kNoPython) ThrowNoPython("surface");
  if (end == ScriptEnd::kFailed) throw InputError("surface: no surface was made, for the reason above");
  if (!is_for_people) PrintResult(ReadSurface(arguments.out), arguments.format);
}

}  // namespace

void AddSurfaceCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "surface", "Model how a rate depends on the conditions, and propose the next conditions");
  command->footer(R"(A model of one quantity of one estimator over the conditions of a run:
  failure   share of the trials that failed
  coverage  truth within the stated 95 % region, of answers with P <= 0.01, or of
            successes if the estimator states no probability
  P-y       stated probability of failure less the failure (1 or 0), of the answers
The report says first whether the model predicts conditions that it has not seen better
than one rate for all. Then follow how much each factor matters (first-order and total
shares of the variance between conditions, with intervals), the effect of each factor,
and maps of two factors. Cells that the model knows too little of are grey.

The folder OUT receives report.txt, the figures (PNG and PDF) and CSV files with every
number. With --propose N it also receives a study, next.yaml: later draws of the same
population, chosen where the model knows least. Run it, then give both runs to this
command. Conditions chosen in this way improve the surface, and enter no rate over the
population. Needs Python with matplotlib, pandas and scipy.

Examples:
  rcme surface run.sqlite --out surface
  rcme surface run.sqlite --estimator rcme_calibrated --quantity P-y --out surface
  rcme surface run.sqlite --propose 32 --out surface
  rcme surface run.sqlite next.sqlite --out surface_2)");
  auto arguments = std::make_shared<SurfaceArguments>();
  command->add_option("runs", arguments->runs, "result files of `rcme run`, with the same factors")
      ->required();
  command->add_option("--quantity", arguments->quantity, "failure, coverage or P-y")
      ->check(MakeChoiceValidator({"failure", "coverage", "P-y"}))
      ->capture_default_str();
  command->add_option("--estimator", arguments->estimator, "its label; default: the study's first");
  command->add_option("--propose", arguments->num_proposed, "so many further draws of the population")
      ->transform(WholeNumberIn(1, 1000));
  command
      ->add_option(
          "--level", arguments->level,
          "with --propose: choose where it is least certain whether the quantity lies above this level")
      ->transform(NumberIn({-1.0, 1.0}))
      ->needs("--propose");
  command->add_flag("--no-figures", arguments->has_no_figures, "write the report and the tables alone");
  command->add_option("-o,--out", arguments->out, "folder to write into; it is made")->required();
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { MakeSurface(*arguments); });
}

}  // namespace rcme
