#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "experiments/base/file_output.h"
#include "experiments/base/stop_request.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/number_option.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/study_file.h"
#include "experiments/truth_free/validate_output.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct ValidateArguments {
  std::string pairs, out;
  EstimatorChoice estimator;
  std::vector<std::string> data;  // key=value each, of a study
  std::string scene;              // empty: all
  double sigma_px = 0.5;
  std::int64_t seed = 1;
  int num_twins = 3, trials = 0;
  bool draws_no_figure = false;
};

std::vector<PairSet> SetsOf(const ValidateArguments& arguments) {
  if (std::filesystem::is_directory(arguments.pairs)) {
    if (!arguments.data.empty() || arguments.trials > 0)
      throw InputError("validate: --data and --trials are of a study; PAIRS is a folder");
    return PairSetsOfFolder(arguments.pairs, arguments.sigma_px);
  }
  Study study = LoadStudy(arguments.pairs);
  for (const std::string& setting : arguments.data) {
    const size_t equals = setting.find('=');
    if (equals == std::string::npos)
      throw InputError(fmt::format("--data: '{}' is not allowed; give key=value", setting));
    Override(&study, setting.substr(0, equals), setting.substr(equals + 1));
  }
  if (arguments.trials > 0) study.trials = arguments.trials;
  return PairSetsOfStudy(MakePlan(study));
}

void RunValidate(const ValidateArguments& arguments) {
  const StopOnSignals stop;
  const std::unique_ptr<MotionEstimator> estimator = Make(ChosenEstimator(arguments.estimator));
  std::vector<PairSet> sets = SetsOf(arguments);
  if (!arguments.scene.empty()) {
    std::string names;
    for (const PairSet& set : sets) names += (names.empty() ? "" : ", ") + set.name;
    std::erase_if(sets, [&](const PairSet& set) { return set.name != arguments.scene; });
    if (sets.empty())
      throw InputError(fmt::format("--scene: '{}' is not there; give one of: {}", arguments.scene, names));
  }
  if (!arguments.out.empty()) MakeResultFolder(arguments.out);
  std::vector<SetReport> reports;
  for (const PairSet& set : sets) {
    reports.push_back(
        Validate(set, *estimator, {static_cast<std::uint64_t>(arguments.seed), arguments.num_twins}));
  }
  const std::string table = ValidationAsTable(reports);
  fmt::print("{}", table);
  if (arguments.out.empty()) return;
  const std::filesystem::path folder(arguments.out);
  WriteFileWhole((folder / "validation.txt").string(), table);
  WriteFileWhole((folder / "validation.csv").string(), ValidationAsCsv(reports));
  const std::string json = (folder / "validation.json").string();
  WriteFileWhole(json, ValidationAsJson(reports));
  if (!arguments.draws_no_figure)
    DrawFigures("validation", {json, "--out", (folder / "validation").string()});
}

}  // namespace

void AddValidateCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("validate", "Do covariances hold on real pairs, whose true motions nobody knows?");
  command->footer(
      "PAIRS is a folder of match files (see `rcme estimate --help`; `# scene:` groups them, `# image1:` "
      "and\n"
      "`# image2:` say which share an image) or a study, whose trials are the pairs.\n"
      "Each test holds differences of estimates against their covariances, and the same of simulated twins:\n"
      "  spatial_halves  left and right, upper and lower half of the matches\n"
      "  random_halves   the same of halves drawn at random: independent errors alone\n"
      "  closure         rotations around loops of three to six images, where pairs name them\n"
      "  directions      directions of translation around three images\n"
      "Beside them: is the calibration right that all pairs share (focal length, principal point,\n"
      "distortion, rolling shutter), does the noise grow as a column sigma_px of the files says, how great\n"
      "is it, and how alike are the residuals of neighbours. A verdict for each scene (holds, too small by\n"
      "..., undecided) and what to change.\n"
      "\n"
      "Examples:\n"
      "  rcme validate PAIRS --out validation\n"
      "  rcme validate PAIRS --set covariance=robust --scene kitti00\n"
      "  rcme validate experiments/studies/indoor_like.yaml --data noise=correlated --trials 40");
  auto arguments = std::make_shared<ValidateArguments>();
  command->add_option("pairs", arguments->pairs, "folder of match files, or a study file (YAML)")->required();
  CLI::Option* estimator =
      command->add_option("--estimator", arguments->estimator.name, "see `rcme list estimators`")
          ->capture_default_str();
  AddEstimatorOptions(command, estimator, &arguments->estimator);
  command->add_option("-o,--out", arguments->out,
                      "folder for validation.txt, .csv, .json and the figure; made if it is missing");
  command->add_option("--scene", arguments->scene, "this scene, or condition of a study, alone");
  command
      ->add_option("--sigma", arguments->sigma_px,
                   "noise standard deviation that a folder's pairs assume, px")
      ->transform(NumberIn({1e-9, 1000.0}))
      ->capture_default_str();
  command->add_option("--data", arguments->data, "key=value, repeatable: a setting of the study's data block")
      ->allow_extra_args(false);
  command->add_option("--trials", arguments->trials, "trials per condition of a study; default: the study's")
      ->transform(WholeNumberIn(1, 1'000'000));
  command->add_option("--twins", arguments->num_twins, "simulated twins of each pair")
      ->transform(WholeNumberIn(1, 100))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "seed of samples, random halves and twins")
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
  command->add_flag("--no-figure", arguments->draws_no_figure, "write the tables alone");
  command->callback([arguments] { RunValidate(*arguments); });
}

}  // namespace rcme
