#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "estimator/loop_inspection.h"
#include "estimator/undistortion.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/core/text/json_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/colmap_camera.h"
#include "experiments/data/match_file.h"
#include "experiments/data/match_folder.h"
#include "experiments/data/match_header.h"
#include "experiments/real/answer/answer_report.h"
#include "experiments/real/camera_noise/apply_noise.h"
#include "experiments/trial/trial.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/constants.h"

namespace rcme {
namespace {

constexpr const char* kStandardInput = "-";
constexpr const char* kJsonLines = "jsonl";

struct EstimateArguments {
  std::vector<std::string> matches;  // files and folders, or kStandardInput
  std::vector<std::string> intrinsics, cameras;
  EstimatorChoice estimator;
  std::optional<double> sigma_px;  // nothing: that of the files
  std::string noise;               // empty: no noise file
  std::int64_t seed = 1;
  std::vector<std::string> bounds;
  std::optional<double> integrity_risk;  // nothing: no protection levels are asked for
  int threads = 0;                       // 0: one per core
  std::string format = "table";
};

std::vector<FailureBounds> ParseAllBounds(const std::vector<std::string>& texts) {
  std::vector<FailureBounds> bounds;
  for (const std::string& text : texts) bounds.push_back(ParseFailureBounds(text));
  return bounds;
}

Lens ParseIntrinsics(const std::string& text) {
  std::array<double, 4> k{};
  const std::vector<std::string> words = SplitAtCommas(text);
  bool are_numbers = words.size() == k.size();
  for (size_t i = 0; are_numbers && i < k.size(); ++i) are_numbers = ParseReal(words[i], &k[i]);
  const Camera camera{k[0], k[1], k[2], k[3], 1, 1};
  if (are_numbers && camera.IsValid()) return {camera};
  throw InputError(
      fmt::format("--K: {} is not allowed; give fx,fy,cx,cy in px, fx and fy > 0", Quoted(text)));
}

// "OPENCV,fx,fy,cx,cy,k1,k2,p1,p2".
Lens ParseNamedCamera(const std::string& text) {
  return LensWithoutSizeFromWords(SplitAtCommas(text), fmt::format("--camera {}", Quoted(text)));
}

// One camera for both images, or one for each.
GivenCameras ParseCameras(const EstimateArguments& arguments) {
  if (!arguments.intrinsics.empty() && !arguments.cameras.empty())
    throw InputError("--K and --camera say the same; give one of them");
  const bool has_lens = !arguments.cameras.empty();
  const std::vector<std::string>& texts = has_lens ? arguments.cameras : arguments.intrinsics;
  if (texts.empty()) return std::nullopt;
  if (texts.size() > 2)
    throw InputError(fmt::format("{}: given more than twice; give it once for both images, or once for each",
                                 has_lens ? "--camera" : "--K"));
  const auto parse = has_lens ? ParseNamedCamera : ParseIntrinsics;
  return CamerasOfOption{{parse(texts.front()), parse(texts.back())}, has_lens ? "--camera" : "--K"};
}

// The files that the arguments name, with folders replaced by their files.
std::vector<std::string> ListFiles(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  for (const std::string& argument : arguments) {
    if (argument == kStandardInput && arguments.size() > 1)
      throw InputError("estimate: '-' (standard input) stands alone; give files, or a single '-'");
    if (!std::filesystem::is_directory(argument)) {
      files.push_back(argument);
      continue;
    }
    for (const std::filesystem::path& file : MatchFilesIn(argument)) files.push_back(file.string());
  }
  return files;
}

// A pair of images as its file has it.
struct ReadPair {
  TrialData data = {};
  double seconds_between = kNaN;
  std::vector<size_t> rows;  // of the matches in a file with lenses (match_file.h)
  size_t num_rows = 0;
};

// Reads pairs and estimates their motions.
class Answerer {
 public:
  explicit Answerer(const EstimateArguments& arguments)
      : arguments_(arguments),
        given_(ParseCameras(arguments)),
        bounds_(ParseAllBounds(arguments.bounds)),
        spec_(ChosenEstimator(arguments.estimator)),
        estimator_(Make(spec_)) {
    CheckProcessEstimators({spec_});
    if (!arguments.noise.empty()) noise_ = ReadNoiseToApply(arguments.noise);
  }

  AnswerTerms terms() const { return {spec_, bounds_, arguments_.integrity_risk}; }
  const MotionEstimator& estimator() const { return *estimator_; }

  // Throws InputError (match_file.h). `doubts`: about the file's cameras.
  ReadPair Read(const std::string& path, std::vector<InputDoubt>* doubts) const {
    const bool is_input = path == kStandardInput;
    MatchFile file = is_input ? ReadMatchesFromInput(given_) : ReadMatchFile(path, given_);
    *doubts = file.doubts;
    ReadPair pair{.seconds_between = file.seconds_between, .rows = file.rows, .num_rows = file.num_rows};
    TrialData& data = pair.data;
    data.origin = file.path;
    data.truth.cam2_from_cam1_true = file.cam2_from_cam1_true;
    data.truth.sd = file.truth_sd;
    data.problem = MakeMotionProblem(std::move(file), arguments_.sigma_px);
    if (noise_) data.problem = ApplyNoise(std::move(data.problem), *noise_, data.origin);
    return pair;
  }

  // `is_posterior_kept`: costs some milliseconds (rcme_calibrated.h).
  PairAnswer Answer(const ReadPair& pair, bool is_posterior_kept) const {
    PairAnswer answer = AnswerMatches(pair, is_posterior_kept && !noise_);
    if (!pair.data.problem.undistortion) return answer;
    RestoreDistorted(pair.data.problem, pair.rows, pair.num_rows, &answer.estimate);
    answer.num_left_out = static_cast<int>(pair.num_rows - pair.rows.size());
    return answer;
  }

 private:
  PairAnswer AnswerMatches(const ReadPair& pair, bool is_posterior_kept) const {
    PairAnswer answer;
    TrialData data = pair.data;
    EstimateForBounds found = Ask(data.problem, is_posterior_kept);
    if (noise_ && RemovesReadout(*noise_) && found.estimate.status == MotionStatus::kOk) {
      data.problem = CorrectReadout(std::move(data.problem), found.estimate.cam2_from_cam1, *noise_,
                                    pair.seconds_between);
      found = Ask(data.problem, is_posterior_kept);
    }
    if (noise_) WidenCovariance(data.problem, *noise_, HasRobustCovariance(spec_), &found.estimate);
    answer.estimate = std::move(found.estimate);
    answer.for_bounds = std::move(found.probabilities);
    if (found.posterior) answer.posterior = SummarizePosterior(*found.posterior);
    answer.record = Score(answer.estimate, data, 0.0);
    answer.has_truth_sd = data.truth.sd.has_value();
    answer.has_prior = data.problem.prior.has_value();
    if (answer.estimate.status != MotionStatus::kOk) return answer;
    answer.evidence = ComputeEvidence(data.problem, answer.estimate);
    if (!noise_ && !StatesCalibrationErrors(spec_))
      answer.calibration_effects = ComputeCalibrationEffects(data.problem, answer.estimate);
    if (const std::optional<double> risk = arguments_.integrity_risk)
      answer.protection = {*risk, ComputeProtectionLevels(answer.estimate, *risk)};
    return answer;
  }

  EstimateForBounds Ask(const MotionProblem& problem, bool is_posterior_kept) const {
    return AnswerProblem(*estimator_, problem, {bounds_, is_posterior_kept},
                         static_cast<std::uint64_t>(arguments_.seed));
  }

  const EstimateArguments& arguments_;
  GivenCameras given_;
  std::vector<FailureBounds> bounds_;
  EstimatorSpec spec_;
  std::unique_ptr<MotionEstimator> estimator_;
  std::optional<CameraNoise> noise_;
};

// The tests of the motion are off as printed. A person should know what they would have said.
void PrintCaution(const LoopInspection& inspection, const MotionProblem& problem, std::int64_t seed) {
  RansacOptions tested = inspection.options();
  if (tested.ObservabilityLevelOrDefault() < 1.0 || tested.ChanceLevelOrDefault() < 1.0) return;
  tested.observability_significance_level = tested.chance_significance_level = 0.001;
  RandomStream rng = StreamFor({static_cast<std::uint64_t>(seed), 0, 0, 0}, StreamPurpose::kSampling);
  const std::unique_ptr<LoopInspection> loop = inspection.With(tested);
  Refinements refinements;
  const MotionEstimate estimate =
      loop->Finish(problem, loop->Decide(loop->Trace(problem, rng)), &refinements);
  if (estimate.status == MotionStatus::kOk) return;
  fmt::print(
      "caution: {} - {}\n  (--set observability_significance_level=0.001 --set "
      "chance_significance_level=0.001 refuses such an answer)\n",
      StatusName(estimate.status), estimate.message);
}

// Answers a file; an error in it is part of the result.
FileAnswer AnswerFile(const Answerer& answerer, const std::string& path) {
  FileAnswer file{.path = path};
  try {
    file.answer = answerer.Answer(answerer.Read(path, &file.doubts), false);
  } catch (const InputError& error) {
    file.error = error.what();
  }
  return file;
}

// Prints one line of JSON and flushes it, so that a reader gets each answer at once.
void PrintJsonLine(const FileAnswer& file, const AnswerTerms& terms) {
  nlohmann::ordered_json line = {{"format", kEstimateFormat}, {"file", file.path}};
  line.update(FileAnswerAsJson(file, terms));
  fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  std::fflush(stdout);
}

void AnswerOne(const EstimateArguments& arguments, const Answerer& answerer, const std::string& path) {
  FileAnswer file{.path = path};
  const ReadPair pair = answerer.Read(path, &file.doubts);
  InputWarnings warnings;
  warnings.Add(file.doubts);
  warnings.Print();
  file.answer = answerer.Answer(pair, true);
  const AnswerTerms terms = answerer.terms();
  if (arguments.format == kJsonLines) {
    PrintJsonLine(file, terms);
  } else {
    PrintResult({AnswerAsText(file.answer, terms.spec), MakeFileAnswerTable({file}, terms),
                 JsonText(kEstimateFormat, FileAnswerAsJson(file, terms))},
                arguments.format);
  }
  const LoopInspection* const inspection = FindInspection(answerer.estimator());
  if (arguments.format == "table" && inspection && file.answer.estimate.status == MotionStatus::kOk)
    PrintCaution(*inspection, pair.data.problem, arguments.seed);
  // A refusal because of what the file holds is bad input; a refusal by the estimator's own tests is its
  // answer.
  if (IsBadInput(file.answer.estimate.status))
    throw InputError(fmt::format("{}: {}", pair.data.origin, file.answer.estimate.message));
}

// Processes every file even if others fail; the program fails at the end if any file did.
void AnswerMany(const EstimateArguments& arguments, const Answerer& answerer,
                const std::vector<std::string>& files) {
  const StopOnSignals stop;
  const AnswerTerms terms = answerer.terms();
  std::vector<FileAnswer> answers;
  std::int64_t num_done = 0;
  bool is_any_bad = false;
  InputWarnings warnings;
  const auto add = [&](FileAnswer file) {
    warnings.Add(file.doubts);
    if (!file.error.empty()) PrintMessage("rcme: {}\n", Printable(file.error));
    is_any_bad |= !file.error.empty() || IsBadInput(file.answer.estimate.status);
    ++num_done;
    if (arguments.format == kJsonLines) return PrintJsonLine(file, terms);
    answers.push_back(std::move(file));
  };
  try {
    Progress progress("pairs", std::ssize(files), 0);
    MakeInOrder(
        std::ssize(files), arguments.threads,
        [&](std::int64_t i) { return AnswerFile(answerer, files[static_cast<size_t>(i)]); },
        [&](FileAnswer file) {
          add(std::move(file));
          progress.Advance(1);
        });
  } catch (const Stopped&) {  // also while an estimator outside the program was waited for
  }
  if (arguments.format != kJsonLines) PrintResult(MakeAnswersResult(answers, terms), arguments.format);
  warnings.Print();
  if (IsStopRequested()) throw Stopped(fmt::format("stopped after {} of {} pairs", num_done, files.size()));
  if (is_any_bad) throw EndWith{2};
}

void RunEstimate(const EstimateArguments& arguments) {
  const Answerer answerer(arguments);
  const std::vector<std::string> files = ListFiles(arguments.matches);
  const bool is_one = arguments.matches.size() == 1 && files.front() == arguments.matches.front();
  if (is_one) return AnswerOne(arguments, answerer, files.front());
  AnswerMany(arguments, answerer, files);
}

}  // namespace

void AddEstimateCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("estimate", "Estimate the motion between two images from match files");
  command->footer(R"(Prints the rotation and direction of camera 2, how certain they are, and the evidence:
inliers, the noise of their residuals compared with the assumed one, parallax, and the
share of matches that could lie on one plane. If there is no motion, it says why and
what to try.

For several files, or a folder, it prints a table with a row per file. --format json is
one document; --format jsonl prints a line of JSON for each file as soon as it is
answered. '-' reads standard input. A file may have just four columns
x1 y1 x2 y2, separated by commas or blanks; give the intrinsics with --K, once for both
images or once for each. A K that does not fit the size of the images or the positions
of the key points gives a warning; an impossible K is refused.

For images that a lens distorts, give --camera MODEL,parameters, or a header line
'# camera1: MODEL w h parameters', with a camera model of COLMAP. Matches are undistorted
and weighed by how much that magnifies their noise; --sigma is the noise in the images
as they were taken.

The default estimator, rcme_calibrated, states the probability that its motion is wrong;
--estimator rcme is that of the paper. An estimator file (YAML) has a name, a label and
options, so an estimator that you tuned by simulation runs on real pairs with the same
options. Its answer has its label. For example:
  name: rcme
  label: tuned_for_my_camera
  options: {reading: rank_aware, mu: 5.25, lambda: 0.6}
`rcme run STUDY --add-estimator tuned.yaml` reads the same file.

Examples:
  rcme estimate matches.csv.gz --sigma 0.7 --format json
  rcme estimate pairs/                                  a line per file
  rcme estimate pairs/ --format jsonl                   a line of JSON per file
  rcme estimate matches.csv.gz --bounds 1,5 --bounds 5,20
  rcme estimate pairs/ --noise noise.yaml               of rcme calibrate-noise
  rcme estimate bare.txt --K 800,800,319.5,239.5        four columns, no header
  rcme estimate raw.txt --camera OPENCV,458.7,457.3,367.2,248.4,-.283,.074,.0002,.00002
  some_matcher a.jpg b.jpg | rcme estimate - --K 800,800,319.5,239.5
  rcme estimate matches.csv.gz --estimator standard --set num_iterations=1000
  rcme estimate matches.csv.gz --estimator-file tuned.yaml --set mu=6

Exit codes: 0 answered or refused; 2 if a file cannot be read or is no problem (too few
matches, all matches on a line).)");
  auto arguments = std::make_shared<EstimateArguments>();
  command
      ->add_option("matches", arguments->matches,
                   "match files (plain or gzip), folders of them, or - for standard input; "
                   "header '# size1: w h', '# K1_fx_fy_cx_cy: ...' and 2, rows x1,y1,x2,y2")
      ->required();
  command
      ->add_option("--K", arguments->intrinsics,
                   "fx,fy,cx,cy in px, for files without intrinsics; give it twice if the images differ")
      ->allow_extra_args(false);
  command
      ->add_option(
          "--camera", arguments->cameras,
          "MODEL,parameters in px, in place of --K for images that a lens distorts: a camera model of "
          "COLMAP with its parameters, such as OPENCV,fx,fy,cx,cy,k1,k2,p1,p2; give it twice if the "
          "images differ")
      ->allow_extra_args(false);
  AddEstimatorOptions(command, &arguments->estimator);
  AddSigmaOption(command, &arguments->sigma_px);
  AddNoiseFileOption(command, &arguments->noise);
  AddSeedOption(command, &arguments->seed);
  command
      ->add_option("--bounds", arguments->bounds,
                   "R,D: also state the probability that the rotation is off by more than R deg or the "
                   "direction by more than D deg, from the same fit; may be given several times; only "
                   "rcme_calibrated")
      ->allow_extra_args(false);
  command
      ->add_option("--integrity-risk", arguments->integrity_risk,
                   "also state the angles that the errors of rotation and direction exceed with at most this "
                   "probability each")
      ->transform(NumberIn({1e-12, 0.999}));
  command
      ->add_option("--threads", arguments->threads,
                   "of many files; 0: one per core. Answers and their order do not depend on it")
      ->transform(WholeNumberIn(0, 1024))
      ->capture_default_str();
  std::vector<std::string> formats = ListResultFormats();
  formats.emplace_back(kJsonLines);
  command
      ->add_option("--format", arguments->format,
                   "of what is printed: table (for people), csv, json, latex, markdown, or jsonl (a line of "
                   "JSON per file). In JSON R (9) and pose_cov (36, of [w, dt]) are row-major; without a "
                   "direction (direction_not_observable) there are only R and rotation_cov (9)")
      ->check(MakeChoiceValidator(formats))
      ->capture_default_str();
  command->callback([arguments] { RunEstimate(*arguments); });
}

}  // namespace rcme
