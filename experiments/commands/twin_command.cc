#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <set>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/commands/scene_choice.h"
#include "experiments/commands/shard_options.h"
#include "experiments/core/files/file_name.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/match_folder.h"
#include "experiments/real/truth_free/twin_output.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_file.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/median_ratio.h"

namespace rcme {
namespace {

struct TwinArguments {
  std::string pairs, out, max_time;
  EstimatorChoice estimator;
  std::string scene;               // empty: all
  std::optional<double> sigma_px;  // nothing: that of the files
  std::int64_t seed = 1;
  int num_twins = 5;
  std::string format = "table";
};

// Paths of a scene's files. --out STUDY.yaml names those of a single scene; a folder takes those of all
// scenes.
struct TwinPlaces {
  std::filesystem::path study, simulated_study, templates;
};

TwinPlaces MakeTwinPlaces(const std::filesystem::path& out, const std::string& scene) {
  if (out.extension() == ".yaml") {
    std::filesystem::path stem = out;
    stem.replace_extension();
    return {out, stem.string() + "_simulated.yaml", stem.string() + "_pairs"};
  }
  const std::string name = MakeFileName(scene);
  return {out / (name + ".yaml"), out / (name + "_simulated.yaml"), out / (name + "_pairs")};
}

// The noise level (px) that the estimator assumed of the median pair. Matches of twins are undistorted, and
// undistortion magnifies the noise of the images.
double ComputeAssumedSigma(const TwinSource& source) {
  std::vector<double> sigmas;
  for (const AnsweredTrial& one : source.pairs) sigmas.push_back(one.pair.problem.sigma_px);
  return ComputeMedian(std::move(sigmas));
}

void WriteTemplates(const TwinSource& source, const std::filesystem::path& folder) {
  MakeResultFolder(folder.string());
  for (const AnsweredTrial& one : source.pairs) {
    if (!one.exact) continue;
    MatchFile file;
    file.scene = source.scene;
    file.image1 = one.image1;
    file.image2 = one.image2;
    file.matches = one.exact->problem.matches;
    file.sigma_px = one.exact->problem.noise_scale;  // only their relation counts
    file.noise_level = one.noise_level;
    file.camera1 = one.exact->problem.camera1;
    file.camera2 = one.exact->problem.camera2;
    file.cam2_from_cam1_true = one.exact->truth.cam2_from_cam1_true;
    WriteMatchFile(file,
                   (folder / (one.pair.origin.substr(0, one.pair.origin.find(".csv")) + ".csv")).string());
  }
}

void WriteStudy(const TwinReport& report, const std::string& kind, const Settings& data, int trials,
                const EstimatorSpec& estimator, const std::filesystem::path& path) {
  Study study;
  study.name = fmt::format("twin_{}_{}", kind, report.scene);
  study.description =
      kind == "semi_real"
          ? "The key points of real pairs at their estimated geometry; noise and wrong matches drawn anew."
          : "A simulated scene with the noise, the wrong matches, the depths and the motion of real pairs.";
  study.trials = trials;
  study.data = data;
  study.estimators = {estimator};
  WriteFileWhole(path.string(), ToYaml(study));
}

using Scenes = std::vector<std::pair<std::string, std::shared_ptr<const DataSource>>>;

WorkPlan PlanTwinSteps(const TwinArguments& arguments, const EstimatorSpec& spec, const Scenes& scenes,
                       const ImageNames& images) {
  std::string identity =
      fmt::format("seed: {}\ntwins: {}\nsigma: {} px\n{}", arguments.seed, arguments.num_twins,
                  arguments.sigma_px.value_or(kUsualSigmaPx), EstimatorFileText(spec, {}));
  for (const auto& [scene, data] : scenes) identity += fmt::format("{}: {}\n", scene, data->Identity());
  for (const auto& [file, names] : images)
    identity += fmt::format("{}: {}, {}\n", file, names.first, names.second);
  return {"twins", "step", identity, {}, true};
}

void RunTwin(const TwinArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.max_time);
  const EstimatorSpec spec = ChosenEstimator(arguments.estimator);
  const std::unique_ptr<MotionEstimator> estimator = Make(spec);
  CheckProcessEstimators({spec});
  ImageNames images;
  StatedSigmas sigmas;
  // Twins are of matches: a sensor's error is not drawn anew.
  Scenes scenes =
      LoadMatchFolder({.folder = arguments.pairs, .sigma_px = arguments.sigma_px, .keeps_priors = false},
                      [&](const MatchFile& file) {
                        AddImageNames(file, &images);
                        if (!arguments.sigma_px) sigmas.Add(file);
                      });
  const std::string names = KeepScene(arguments.scene, &Scenes::value_type::first, &scenes);
  CheckIsNoInput(arguments.out, {arguments.pairs});
  const std::filesystem::path out(arguments.out);
  const bool is_one_study = out.extension() == ".yaml";
  if (is_one_study && scenes.size() > 1)
    throw InputError(fmt::format("--out: {} holds one scene's study; give --scene (one of: {}), or a folder",
                                 arguments.out, names));
  if (is_one_study)
    CheckCanBeWritten(arguments.out);
  else
    MakeResultFolder(arguments.out);
  std::set<std::string> file_names;
  for (const auto& [scene, data] : scenes) {
    if (!file_names.insert(MakeFileName(scene)).second)
      throw InputError(fmt::format(
          "scene {}: its files would have the names of another scene's; give --scene", Quoted(scene)));
  }
  Runner runner = MakeRunner(
      PlanTwinSteps(arguments, spec, scenes, images),
      is_one_study ? FindCheckpointBeside(arguments.out) : FindCheckpointInFolder(arguments.out), 1);
  KeptSteps steps(&runner);
  std::vector<TwinReport> reports;
  for (const auto& [scene, data] : scenes) {
    const auto seed = static_cast<std::uint64_t>(arguments.seed);
    const TwinPlaces places = MakeTwinPlaces(out, scene);
    const TwinSource source = AnswerScene(scene, *data, images, *estimator, seed, &steps);
    reports.push_back(MakeTwinReport(source, *estimator, places.templates.filename().string(),
                                     ComputeAssumedSigma(source), seed, arguments.num_twins, &steps));
    const TwinReport& report = reports.back();
    WriteTemplates(source, places.templates);
    WriteStudy(report, "semi_real", report.semi_real, 20, spec, places.study);
    if (!report.simulated.empty())
      WriteStudy(report, "simulated", report.simulated, 400, spec, places.simulated_study);
  }
  const CommandResult result = MakeTwinsResult(reports);
  if (!is_one_study) WriteResultFiles(result, (out / "twin").string());
  runner.RemoveCheckpoint();
  PrintResult(result, arguments.format);
}

}  // namespace

void AddTwinCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "twin", "Fit simulated studies to real pairs, and report what simulation does not explain");
  command->footer(R"(Writes two studies for `rcme run` for each scene of a folder of match files:
  semi-real  the real key points, moved to agree with the estimated geometry (as match
             files); fresh noise with the size, tails and correlation of the residuals,
             and wrong matches dealt out again
  simulated  a scene of the simulator with the cameras, depths, parallax, motion,
             planarity, clustering, noise and wrong matches of the pairs
It also writes a report that compares what the estimator does on the pairs and on the
twins: refusals, failures, stated probability of failure, estimated noise, inlier test,
tails, stated deviations, halves, and correlation of residuals. The report tests each
difference and lists what simulation does not explain.

If the command is stopped (Ctrl-C, SIGTERM, --max-time) or killed, run it again: finished
work is kept in OUT/unfinished.part, or beside STUDY.yaml, until the end.

Examples:
  rcme twin PAIRS --out twins
  rcme twin PAIRS --scene kitti00 --out kitti00.yaml && rcme run kitti00.yaml --out run.sqlite)");
  auto arguments = std::make_shared<TwinArguments>();
  command->add_option("pairs", arguments->pairs, "folder of match files")->required();
  AddEstimatorOptions(command, &arguments->estimator);
  command
      ->add_option("-o,--out", arguments->out,
                   "for one scene STUDY.yaml, with STUDY_simulated.yaml and STUDY_pairs/ beside it; "
                   "otherwise a folder for those of every scene, twin.txt, .csv and .json")
      ->required();
  command->add_option("--scene", arguments->scene, "only this scene");
  AddSigmaOption(command, &arguments->sigma_px);
  command->add_option("--twins", arguments->num_twins, "number of twins of each kind per pair")
      ->transform(WholeNumberIn(1, 100))
      ->capture_default_str();
  AddTimeLimit(command, "pairs", &arguments->max_time);
  AddFormatOption(command, &arguments->format);
  AddSeedOption(command, &arguments->seed, "samples, halves and twins");
  command->callback([arguments] { RunTwin(*arguments); });
}

}  // namespace rcme
