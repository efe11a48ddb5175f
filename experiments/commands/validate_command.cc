#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/draw_figures.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/scene_choice.h"
#include "experiments/commands/shard_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/table/render_table.h"
#include "experiments/core/text/key_value.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/simulated_sequence.h"
#include "experiments/real/camera_noise/apply_noise.h"
#include "experiments/real/truth_free/advice.h"
#include "experiments/real/truth_free/closure_output.h"
#include "experiments/real/truth_free/kept_answers.h"
#include "experiments/real/truth_free/planted_fault.h"
#include "experiments/real/truth_free/validate_output.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/estimator_spec.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

struct ValidateArguments {
  std::vector<std::string> pairs;
  std::string out, max_time, format = "table";
  EstimatorChoice estimator;
  std::vector<std::string> data;   // key=value each, of a study
  std::string scene;               // empty: all
  std::optional<double> sigma_px;  // nothing: that of the files
  std::string noise;               // empty: no noise file
  std::int64_t seed = 1;
  int num_twins = 3, trials = 0;
  int num_images = 2;                // of each trial of a study
  int longest_loop = 0;              // images; 0: no closure by length
  std::vector<std::string> planted;  // NAME=VALUE each
  bool draws_no_figure = false, tests_alone = false;
};

std::vector<PairSet> ReadSets(const std::string& pairs, const ValidateArguments& arguments) {
  if (std::filesystem::is_directory(pairs)) {
    if (!arguments.data.empty() || arguments.trials > 0 || arguments.num_images > 2)
      throw InputError("validate: --data, --trials and --images need a study; PAIRS is a folder");
    return PairSetsOfFolder(pairs, arguments.sigma_px);
  }
  Study study = LoadStudy(pairs);
  for (const std::string& setting : arguments.data) {
    const auto [key, value, has_equals] = SplitKeyValue(setting);
    if (!has_equals) throw InputError(fmt::format("--data: '{}' is not allowed; give key=value", setting));
    Override(&study, key, value);
  }
  if (arguments.trials > 0) study.trials = arguments.trials;
  const StudyPlan plan = MakePlan(study, PlanEstimators::kNotMade);
  return arguments.num_images > 2 ? SequencesOfStudy(plan, arguments.num_images) : PairSetsOfStudy(plan);
}

// With several folders or studies, the name of each set begins with the name of its folder or study.
std::vector<PairSet> ReadAllSets(const ValidateArguments& arguments) {
  std::vector<PairSet> all;
  for (const std::string& pairs : arguments.pairs) {
    for (PairSet& set : ReadSets(pairs, arguments)) {
      if (arguments.pairs.size() > 1)
        set.name = std::filesystem::path(pairs).lexically_normal().filename().string() + "/" + set.name;
      all.push_back(std::move(set));
    }
  }
  return all;
}

// The chosen estimator, with the planted factor on its covariances.
AdvisedEstimator ChooseAdvised(const EstimatorSpec& spec, const PlantedFaults& planted,
                               const std::optional<CameraNoise>& noise) {
  AdvisedEstimator advised;
  advised.make = [spec, noise, factor = planted.covariance](const Settings& options) {
    EstimatorSpec changed = spec;
    SetOptions(&changed, options);
    std::unique_ptr<MotionEstimator> estimator = Make(changed);
    if (noise) estimator = WithSharedNoise(std::move(estimator), *noise, HasRobustCovariance(changed));
    return factor == 1.0 ? std::move(estimator) : ScaleCovariances(std::move(estimator), factor);
  };
  advised.is_robust = HasRobustCovariance(spec);
  if (const auto factor = FindSetting(spec.options, "covariance_factor")) ParseReal(*factor, &advised.factor);
  return advised;
}

std::vector<PairSet> ChooseSets(const ValidateArguments& arguments, const PlantedFaults& planted) {
  std::vector<PairSet> sets = ReadAllSets(arguments);
  KeepScene(arguments.scene, &PairSet::name, &sets);
  for (PairSet& set : sets) set = PlantFaultsIn(std::move(set), planted);
  return sets;
}

WorkPlan PlanValidationSteps(const ValidateArguments& arguments, const EstimatorSpec& spec,
                             const PlantedFaults& planted, const std::optional<CameraNoise>& noise,
                             const std::vector<PairSet>& sets) {
  std::string identity = fmt::format("seed: {}\ntwins: {}\nadvice: {}\ncovariances times: {}\n{}",
                                     arguments.seed, arguments.num_twins, !arguments.tests_alone,
                                     planted.covariance, EstimatorFileText(spec, {}));
  if (noise) identity += CameraNoiseAsYaml(*noise);
  for (const PairSet& set : sets) identity += DescribePairs(set) + "\n";
  return {"validation", "step", identity, {}, true};
}

// "rcme_calibrated, covariance=robust".
std::string NameEstimator(const ValidateArguments& arguments) {
  std::string name = arguments.estimator.file ? *arguments.estimator.file : arguments.estimator.name;
  for (const std::string& changed : arguments.estimator.overrides) name += ", " + changed;
  return name;
}

void RunValidate(const ValidateArguments& arguments) {
  CheckIsNoInput(arguments.out, arguments.pairs);
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const PlantedFaults planted = ParsePlantedFaults(arguments.planted);
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  CheckProcessEstimators({spec});
  std::optional<CameraNoise> noise;
  if (!arguments.noise.empty()) noise = ReadNoiseToApply(arguments.noise);
  const AdvisedEstimator estimator = ChooseAdvised(spec, planted, noise);
  std::vector<PairSet> sets = ChooseSets(arguments, planted);
  if (noise) {
    const auto own = Make(spec);
    for (PairSet& set : sets)
      set = ApplyNoiseTo(std::move(set), *noise, *own, static_cast<std::uint64_t>(arguments.seed));
  }
  std::optional<Runner> runner;
  std::optional<KeptSteps> kept;
  if (!arguments.out.empty()) {
    MakeResultFolder(arguments.out);
    runner = MakeRunner(PlanValidationSteps(arguments, spec, planted, noise, sets),
                        FindCheckpointInFolder(arguments.out), 1);
    kept.emplace(&*runner);
  }
  KeptSteps* steps = kept ? &*kept : nullptr;
  const ValidationOptions options = {
      static_cast<std::uint64_t>(arguments.seed), arguments.num_twins,
      static_cast<size_t>(arguments.longest_loop),
      noise ? TwinField{noise->DisplacementShare(), noise->reach_px} : TwinField{}};
  std::vector<SetReport> reports;
  for (const PairSet& set : sets)
    reports.push_back(arguments.tests_alone ? Validate(set, *estimator.make({}), options, steps)
                                            : ValidateAndAdvise(set, estimator, options, steps));
  const CommandResult result = MakeValidationResult(reports);
  PrintResult(result, arguments.format);
  if (arguments.out.empty()) return;
  const std::filesystem::path folder(arguments.out);
  const std::string stem = (folder / "validation").string();
  WriteResultFiles(result, stem);
  if (arguments.longest_loop > 0) {
    const Table closures = MakeClosureTable(reports, NameEstimator(arguments));
    WriteFileWhole((folder / "closure.csv").string(), RenderCsv(closures));
  }
  if (!arguments.draws_no_figure) DrawFigures("validation", {stem + ".json", "--out", stem});
  runner->RemoveCheckpoint();
}

}  // namespace

void AddValidateCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand("validate", "Check covariances on real pairs without ground truth");
  command->footer(R"(PAIRS is a folder of match files (see `rcme estimate --help`), or a study whose trials
are the pairs. In a folder, `# scene:` lines group the files, and `# image1:` and
`# image2:` lines tell which files share an image.

Each test compares differences of estimates with their stated covariances, and says
whether simulated twins of the pairs have the same fault:
  spatial_halves  left and right, upper and lower half of the matches
  random_halves   random halves of the matches; tests for independent errors only
  closure         rotations around loops of three to six images, where pairs name them
  directions      directions of translation around three images
  simulation      answers on the twins compared with their true motion; tests the
                  estimator's own covariance for independent errors
The report also estimates the calibration that all pairs share (focal length, principal
point, distortion, key points of the second image; a rolling shutter if files state
# seconds_between), whether the noise grows as the column sigma_px says, the noise level,
and the correlation of neighbouring residuals. Each scene gets a verdict (holds, too
small by ..., or undecided with the number of pairs that would decide), its cause (the
data or the estimator), and advice. The program tries each advised change, validates the
scene again, and reports the result.

--loops 8 also measures how well rotations close around loops of 3, 4, ... and 8 images
and compares that with the covariances propagated around the loop. The loops go forth along
the images in the order of their names and back by one pair; `rcme pairs --window 7` makes
such pairs. With --images 8 each trial of a study is a simulated sequence of 8 images. The
numbers are in closure.csv, for `rcme plot closure`.

If the command is stopped or killed, run it again with --out: finished work is kept in
OUT/unfinished.part until the end.

Examples:
  rcme validate PAIRS --out validation
  rcme validate PAIRS --set covariance=robust --scene kitti00
  rcme validate indoor_like --data noise=correlated --trials 40
  rcme validate indoor_like --images 8 --loops 8 --trials 20 --no-advice
  rcme validate PAIRS --plant focal_length=0.01 --no-advice   would these pairs show it?)");
  auto arguments = std::make_shared<ValidateArguments>();
  command->add_option("pairs", arguments->pairs, "folders of match files, or study files (YAML)")->required();
  AddEstimatorOptions(command, &arguments->estimator);
  command->add_option("-o,--out", arguments->out,
                      "folder for validation.txt, .csv, .json and the figure, created if missing");
  AddFormatOption(command, &arguments->format);
  command->add_option("--scene", arguments->scene, "only this scene, or this condition of a study");
  AddSigmaOption(command, &arguments->sigma_px);
  AddNoiseFileOption(command, &arguments->noise);
  command->add_option("--data", arguments->data, "key=value, repeatable: a setting of the study's data block")
      ->allow_extra_args(false);
  command->add_option("--trials", arguments->trials, "trials per condition of a study; default: the study's")
      ->transform(WholeNumberIn(1, 1'000'000));
  command
      ->add_option("--images", arguments->num_images,
                   "images of each trial of a study: a simulated sequence, where there are more than two")
      ->transform(WholeNumberIn(2, kMostSequenceImages))
      ->capture_default_str();
  command
      ->add_option("--loops", arguments->longest_loop,
                   "also measure the closure of loops of 3 to this many images, by their number")
      ->transform(WholeNumberIn(3, static_cast<std::int64_t>(kMostLoopImages)));
  command->add_option("--twins", arguments->num_twins, "simulated twins of each pair")
      ->transform(WholeNumberIn(1, 100))
      ->capture_default_str();
  AddSeedOption(command, &arguments->seed, "samples, random halves and twins");
  command
      ->add_option("--plant", arguments->planted,
                   "NAME=VALUE, repeatable: plant a fault first, to see whether these pairs reveal it. "
                   "covariance and sigma are factors; the others have the units of the report (focal_length "
                   "0.01 is 1 %). "
                   "NAME is one of: " +
                       PlantableFaults())
      ->allow_extra_args(false);
  AddTimeLimit(command, "pairs", &arguments->max_time);
  command->add_flag("--no-advice", arguments->tests_alone, "only run the tests; try no changes");
  command->add_flag("--no-figure", arguments->draws_no_figure, "write only the tables");
  command->callback([arguments] { RunValidate(*arguments); });
}

}  // namespace rcme
