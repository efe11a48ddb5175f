#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/files/yaml_input.h"
#include "experiments/core/table/read_csv_table.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/population.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kPoolDraws = 20'000;  // of the population, among which the search chooses

struct WorstArguments {
  std::string study, out, estimator, against, quantity = "failure", format = "table";
  StudyChanges changes;
  int trials = 0, minutes = 0, regions = 3, fresh = 300, threads = 0;
  double claim = -1.0;
};

// The study with only the compared estimators, in this order, and only the draws of its population as
// conditions.
Study MakeSearchStudy(const WorstArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (!study.population || !study.factors.empty() || study.population->design == PointSet::kLatinHypercube)
    throw InputError(
        "worst: the study needs a block `conditions` with the design sobol or random, and no factors");
  std::vector<EstimatorSpec> chosen;
  for (const std::string& label : {arguments.estimator, arguments.against}) {
    if (label.empty()) continue;
    chosen.push_back(study.estimators[FindEstimator(study.estimators, label, "worst: the study")]);
  }
  study.estimators = chosen;
  study.population->draws.clear();
  study.population->number = kPoolDraws;
  study.repeats_per_scene = 1;
  study.ademp.reset();
  study.tuning.reset();
  CheckProcessEstimators(study.estimators);
  return study;
}

// The draws that are conditions, with their levels.
std::string PoolAsCsv(const Study& study) {
  std::string text = fmt::format("draw,{}\n", fmt::join(ListDrawnKeys(*study.population), ","));
  for (const PopulationDraw& draw : DrawPopulation(study)) {
    if (draw.outside_of.empty()) text += fmt::format("{},{}\n", draw.number, fmt::join(draw.levels, ","));
  }
  return text;
}

void FindWorst(const WorstArguments& arguments) {
  if ((arguments.quantity == "difference") == arguments.against.empty())
    throw InputError("worst: --against goes with --quantity difference, and that with --against");
  const Study study = MakeSearchStudy(arguments);
  MakeResultFolder(arguments.out);
  const std::filesystem::path folder(arguments.out);
  const std::string text = ToYaml(study), study_path = (folder / "study.yaml").string();
  if (std::filesystem::exists(study_path) && ReadInputText(study_path, {"study file", "a study"}) != text)
    throw InputError(
        fmt::format("--out: {} holds the search of another study; give another folder", arguments.out));
  WriteFileWhole(study_path, text);
  WriteFileWhole((folder / "pool.csv").string(), PoolAsCsv(study));
  std::vector<std::string> words = {arguments.out,
                                    "--rcme",
                                    std::filesystem::read_symlink("/proc/self/exe").string(),
                                    "--quantity",
                                    arguments.quantity,
                                    "--trials",
                                    fmt::format("{}", arguments.trials),
                                    "--minutes",
                                    fmt::format("{}", arguments.minutes),
                                    "--regions",
                                    fmt::format("{}", arguments.regions),
                                    "--fresh",
                                    fmt::format("{}", arguments.fresh),
                                    "--threads",
                                    fmt::format("{}", arguments.threads)};
  for (const EstimatorSpec& spec : study.estimators) words.insert(words.end(), {"--estimator", spec.label});
  if (arguments.claim >= 0.0) words.insert(words.end(), {"--claim", fmt::format("{}", arguments.claim)});
  if (arguments.changes.allow_process) words.push_back("--allow-process");
  const bool is_for_people = arguments.format == "table";
  const ScriptEnd end =
      RunPlotScript("worst", words, is_for_people ? ScriptOutput::kShown : ScriptOutput::kDropped);
  if (end == ScriptEnd::kNoPython) ThrowNoPython("worst");
  if (end == ScriptEnd::kFailed)
    throw InputError(fmt::format(
        "worst: not finished, for the reason above; {}/trials holds the finished trials, which the same "
        "command does not run again",
        arguments.out));
  if (is_for_people) return;
  const auto read = [&](const char* name) {
    return ReadInputText((folder / name).string(), {"result", "a result of `rcme worst`"});
  };
  PrintResult({"", ReadCsvTable(read("worst.csv")), read("worst.json")}, arguments.format);
}

}  // namespace

void AddWorstCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("worst", "Find regions of a population in which an estimator is worst");
  command->footer(R"(Searches the population of a study (its block `conditions`) for regions in which an event
is frequent, and then measures its rate there with fresh trials. The search's own trials
do not enter the rates, and the intervals of all regions hold together.

  failure       share of the trials that failed
  sure_failure  share that failed, of the answers with a stated probability of at most 0.1
  miscoverage   truths outside of the stated 95 % region, of answers with P <= 0.01, or of
                successes if the estimator states no probability; beside it the median of the
                stated standard deviations
  difference    failed, less that of --against on the same trials

The folder OUT receives worst.txt, worst.csv and worst.json, and of each region a study
that anyone can run (region_1.yaml), a failing trial with its explanation (region_1.txt)
and its picture (region_1.png, region_1.pdf). If the command is stopped or killed, run it
again: what OUT/trials holds is not run again. Needs Python with matplotlib, pandas,
scikit-learn and yaml.

Examples:
  rcme worst any_condition --estimator rcme_calibrated --quantity sure_failure --out sure
  rcme worst any_condition --estimator rcme_calibrated --trials 3000 --out failing
  rcme worst any_condition --estimator opencv_magsac --against standard_five_point \
      --quantity difference --minutes 10 --out difference)");
  auto arguments = std::make_shared<WorstArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option("--estimator", arguments->estimator, "its label")->required();
  command->add_option("--against", arguments->against, "label of the estimator that a difference is from");
  command->add_option("--quantity", arguments->quantity, "failure, sure_failure, miscoverage or difference")
      ->check(MakeChoiceValidator({"failure", "sure_failure", "miscoverage", "difference"}))
      ->capture_default_str();
  CLI::Option* trials =
      command->add_option("--trials", arguments->trials, "how many may be spent; default: 5000")
          ->transform(WholeNumberIn(500, 10'000'000));
  command
      ->add_option("--minutes", arguments->minutes,
                   "as many trials as take so long, by the time of the first 64 draws")
      ->transform(WholeNumberIn(1, 100'000))
      ->excludes(trials);
  command->add_option("--regions", arguments->regions, "at most so many are reported")
      ->transform(WholeNumberIn(1, 20))
      ->capture_default_str();
  command->add_option("--fresh", arguments->fresh, "fresh trials of each region")
      ->transform(WholeNumberIn(20, 1'000'000))
      ->capture_default_str();
  command
      ->add_option("--claim", arguments->claim,
                   "a region is a find if its whole interval lies above; default: failure 0.5, sure_failure "
                   "0.1, miscoverage 0.05, difference 0")
      ->transform(NumberIn({0.0, 1.0}));
  command->add_option("-o,--out", arguments->out, "folder to write into; it is made")->required();
  AddFormatOption(command, &arguments->format);
  AddStudyOptions(command, &arguments->changes);
  AddProcessOption(command, &arguments->changes.allow_process);
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { FindWorst(*arguments); });
}

}  // namespace rcme
