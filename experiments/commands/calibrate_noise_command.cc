#include <fmt/format.h>

#include <memory>
#include <optional>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/scene_choice.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/camera_noise/calibrate_noise_output.h"
#include "experiments/study/estimator_spec.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

struct CalibrateNoiseArguments {
  std::string pairs, out, scene, format = "table";
  EstimatorChoice estimator;
  std::optional<double> sigma_px;  // nothing: that of the files
  std::int64_t seed = 1;
};

// The pairs of all scenes of a folder, or of one.
PairSet ReadPairsOfCamera(const CalibrateNoiseArguments& arguments) {
  std::vector<PairSet> sets = PairSetsOfFolder(arguments.pairs, arguments.sigma_px);
  const std::string names = KeepScene(arguments.scene, &PairSet::name, &sets);
  PairSet all{arguments.scene.empty() ? names : arguments.scene, {}};
  for (PairSet& set : sets) std::ranges::move(set.pairs, std::back_inserter(all.pairs));
  return all;
}

void RunCalibrateNoise(const CalibrateNoiseArguments& arguments) {
  const StopOnSignals stop;
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  CheckProcessEstimators({spec});
  if (!arguments.out.empty()) {
    for (const std::filesystem::path& input : MatchFilesIn(arguments.pairs))
      CheckIsNoInput(arguments.out, {input.string()});
    CheckCanBeWritten(arguments.out);
  }
  const PairSet set = ReadPairsOfCamera(arguments);
  const NoiseCalibration calibration =
      CalibrateNoise(set, *Make(spec), spec.label, static_cast<std::uint64_t>(arguments.seed));
  if (!arguments.out.empty()) WriteFileWhole(arguments.out, CameraNoiseAsYaml(calibration.noise));
  PrintResult(MakeNoiseCalibrationResult(calibration, set.name), arguments.format);
}

}  // namespace

void AddCalibrateNoiseCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("calibrate-noise", "Learn the noise and the errors of a camera from its pairs");
  command->footer(
      R"(PAIRS is a folder of match files (see `rcme estimate --help`). The pairs of one camera are
pooled; those of another than the first are left out, and --scene picks a scene. No true
motion is needed: everything is learnt from the residuals at the estimated motions.

  sigma              of the noise, and how it grows with the column sigma_px (key-point
                     size), if the files have one
  displacement field what matches near each other share: its size and reach, tested
                     against independent noise
  camera faults      focal length, principal point, distortion k1, rolling shutter (if
                     files state # seconds_between) and key points of the second image,
                     beside each other, until the steps converge; named only if the test
                     of all faults together says so, removed if more probable than not.
                     `+-x is left`: root mean square of what the pairs leave open of
                     a fault, after what is removed; covariances are widened by it
  displacement of    what is left of the lens in all images, over 6x4 cells, tested
  all images         against chance

--out writes a noise file. `rcme estimate --noise FILE` and `rcme validate --noise FILE`
remove the errors that were found and take the noise; a study with the data
{noise: from_file, noise_file: FILE} draws it.

Examples:
  rcme calibrate-noise PAIRS --out noise.yaml
  rcme calibrate-noise PAIRS --scene kitti00 --format json
  rcme estimate PAIRS --noise noise.yaml)");
  auto arguments = std::make_shared<CalibrateNoiseArguments>();
  command->add_option("pairs", arguments->pairs, "folder of match files")->required();
  AddEstimatorOptions(command, &arguments->estimator);
  command->add_option("-o,--out", arguments->out, "noise file (YAML)");
  command->add_option("--scene", arguments->scene, "only this scene");
  AddSigmaOption(command, &arguments->sigma_px);
  AddSeedOption(command, &arguments->seed);
  AddFormatOption(command, &arguments->format);
  command->callback([arguments] { RunCalibrateNoise(*arguments); });
}

}  // namespace rcme
