#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>

#include "experiments/ask/answer_output.h"
#include "experiments/ask/question.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/duration.h"
#include "experiments/core/text/message.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/run/run_study.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "parameters/input_error.h"
#include "parameters/suggestion.h"
#include "simulator/motion_registry.h"
#include "simulator/outlier_registry.h"

namespace rcme {
namespace {

constexpr int kPilotTrials = 20;  // to measure the time per trial
constexpr int kFewestTrials = 50;

struct AskArguments {
  AskedTexts texts;
  Question question;
  std::string within = "2m", format = "table";
  std::string out;  // empty: MakeFolderName
  double at_most = 0.05;
  int trials = 0;  // 0: as many as the time allows
  int threads = 0;
};

std::string ResultPath(const AskArguments& arguments) { return arguments.out + "/run.sqlite"; }

// Throws InputError if the folder holds a study that no earlier call has run.
void RequireOwnStudy(const AskArguments& arguments) {
  const std::string path = arguments.out + "/study.yaml";
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::exists(ResultPath(arguments), ignored))
    throw InputError(
        fmt::format("--out: {} is there already, without a run.sqlite; give another folder", path));
}

// Throws InputError if the simulator cannot make the question's problems, before anything is written.
void RequireSimulable(const AskArguments& arguments) {
  const std::string path = arguments.out + "/study.yaml";
  const StudyPlan plan = MakePlan(ParseStudy(MakeStudyText(arguments.question, kPilotTrials), path), path);
  const Condition& condition = plan.conditions[0];
  for (std::uint32_t trial = 0; trial < kPilotTrials; ++trial)
    condition.source->Make(NameOfScene(plan, condition, trial));
}

// Runs the question's study up to `trials` trials and keeps those that the result file already has. If the
// file belongs to another question, nothing is written, not even study.yaml.
RunReport RunAskedTrials(const AskArguments& arguments, int trials) {
  const std::string path = arguments.out + "/study.yaml";
  const std::string text = MakeStudyText(arguments.question, trials);
  const StudyPlan plan = MakePlan(ParseStudy(text, path), path);
  ResultStore store = ResultStore::OpenForRun(ResultPath(arguments), plan);
  WriteFileWhole(path, text);
  return RunStudy(plan, arguments.threads, &store);
}

// As many trials, to two digits, as the time suffices for by the time of the pilot trials; the fewest if the
// pilot ran none now. It does not depend on any outcome, so the intervals stay valid.
int ChooseTrials(const RunReport& pilot, double seconds) {
  if (pilot.num_run_now == 0) return kFewestTrials;
  const double seconds_per_trial = pilot.seconds / static_cast<double>(pilot.num_run_now);
  const double trials = std::clamp(0.85 * seconds / seconds_per_trial, 1.0 * kFewestTrials, 5000.0);
  const double step = trials < 100.0 ? 1.0 : trials < 1000.0 ? 10.0 : 100.0;
  return static_cast<int>(step * std::floor(trials / step));
}

// The number of trials that the existing result file holds, and at least that which was last requested for
// it, if the run was interrupted; 0: there is no file.
int CountEarlierTrials(const AskArguments& arguments) {
  if (!std::filesystem::exists(ResultPath(arguments))) return 0;
  const ResultStore store = ResultStore::OpenForReading(ResultPath(arguments));
  return std::max(store.Description().trials, static_cast<int>(store.NumTrials()));
}

// Runs the requested number of trials, else the number requested before, else as many as fit into the time.
void RunQuestion(const AskArguments& arguments) {
  const int before = CountEarlierTrials(arguments);
  if (arguments.trials > 0) {
    RunAskedTrials(arguments, arguments.trials);
    const auto held = ResultStore::OpenForReading(ResultPath(arguments)).NumTrials();
    if (held > arguments.trials)
      PrintMessage("The answer is of all {} trials that {} holds\n", held, ResultPath(arguments));
  } else if (before > kPilotTrials) {
    RunAskedTrials(arguments, before);
    PrintMessage("The answer is of the {} trials that {} holds; --trials N takes more\n", before,
                 ResultPath(arguments));
  } else {
    const int trials =
        ChooseTrials(RunAskedTrials(arguments, kPilotTrials), ParseDuration(arguments.within).value());
    PrintMessage("{} trials of each estimator, within about {}\n", trials, arguments.within);
    RunAskedTrials(arguments, trials);
  }
}

void RunAsk(AskArguments arguments) {
  const StopOnSignals stop;
  const std::vector<std::string> missing = MissingOptions(arguments.texts);
  if (!missing.empty() && isatty(STDIN_FILENO) == 0) {
    throw InputError(fmt::format("ask: {}: missing; give {}, or answer at a terminal",
                                 fmt::join(missing, ", "), missing.size() == 1 ? "it" : "them"));
  }
  ReadTexts(arguments.texts, &arguments.question);
  AskForMissing(std::cin, std::cerr, &arguments.texts);
  ReadTexts(arguments.texts, &arguments.question);
  CheckOutliers(arguments.question);
  if (arguments.out.empty()) arguments.out = MakeFolderName(arguments.question);
  RequireOwnStudy(arguments);
  RequireSimulable(arguments);
  MakeResultFolder(arguments.out);
  RunQuestion(arguments);
  const Answer answer = AnswerQuestion(ResultStore::OpenForReading(ResultPath(arguments)), arguments.question,
                                       arguments.at_most);
  const std::string question = DescribeQuestion(arguments.question);
  PrintResult(MakeAnswerResult(answer, question, arguments.out), arguments.format);
}

// "5%" is 0.05.
CLI::Validator PercentAsShare() {
  return {[](std::string& text) {
            double share = 0.0;
            if (text.ends_with('%') && ParseShare(text, &share) && share <= 1.0)
              text = fmt::format("{}", share);
            return std::string();
          },
          ""};
}

}  // namespace

void AddAskCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "ask", "Answer for your camera: which estimator, how far to trust it, how many trials");
  command->footer(R"(Writes a study of one condition, runs as many trials as the time allows, and answers in
about ten lines: the estimator that succeeds most often among rcme_calibrated, tuned
RCME, MSAC, OpenCV's MAGSAC and OpenGV's RANSAC, and which of the others the trials
cannot tell from it (of those that succeed as often the fastest leads whose errors are
not greater by more than chance); up to which stated probability of failure to accept answers;
whether probabilities and covariances are right; what each of the tied takes for an
inlier; and how many trials tell the first two apart. The answer takes the calibration
and the noise as exact: --focal-error shows what a wrong focal length does. Without the first five options it asks for them
at a terminal, and for --motion and --outliers, which have defaults.

The study, the result file and what you can do next are named at the end. Each question
has a folder of its own, so the same command again answers from the trials that are there; --trials N takes more.

Examples:
  rcme ask
  rcme ask --image 1280x720 --focal 900 --noise 0.7 --scene corridor --motion forward \
           --wrong 40% --outliers clustered_both --out corridor
  rcme ask --image 640x480 --focal 525 --noise 1 --scene room --wrong 0.2 --within 30s)");
  auto arguments = std::make_shared<AskArguments>();
  AskedTexts& texts = arguments->texts;
  Question& question = arguments->question;
  command
      ->add_option_function<std::vector<std::string>>(
          "--image", [&texts](const auto& words) { texts.image = fmt::format("{}", fmt::join(words, " ")); },
          "size of an image, WIDTHxHEIGHT, px")
      ->expected(1, 3);
  command->add_option("--focal", texts.focal_px, "focal length, px");
  command
      ->add_option("--focal-error", question.focal_error,
                   "relative error of the focal length that estimators assume, such as 0.01")
      ->transform(NumberIn({-0.9, 9.0}))
      ->transform(PercentAsShare())
      ->capture_default_str();
  command->add_option("--noise", texts.sigma_px, "standard deviation of a point's noise per coordinate, px");
  command->add_option("--scene", texts.scene, "kind of scene (`rcme list scenes`)");
  command->add_option("--wrong", texts.wrong, "share of wrong matches, 0 to 0.95 or 0% to 95%");
  command->add_option("--motion", texts.motion, "kind of motion (`rcme list motions`); default: the scene's")
      ->check(MakeChoiceValidator(ListNames(MotionRegistry())));
  command
      ->add_option("--outliers", texts.outliers,
                   "kind of wrong matches (`rcme list outliers`); default: uniform")
      ->check(MakeChoiceValidator(ListNames(OutlierRegistry())));
  command->add_option("--matches", question.num_matches, "matches of a pair, wrong ones included")
      ->transform(WholeNumberIn(8, 100'000))
      ->capture_default_str();
  command
      ->add_option("--max-rotation-error", question.max_rotation_error_deg,
                   "a motion with a greater rotation error has failed, deg")
      ->transform(NumberIn({1e-6, 180.0}))
      ->capture_default_str();
  command
      ->add_option("--max-direction-error", question.max_direction_error_deg,
                   "a motion with a greater error of the direction has failed, deg")
      ->transform(NumberIn({1e-6, 180.0}))
      ->capture_default_str();
  command->add_option("--at-most", arguments->at_most, "rate of failure among the answers that you accept")
      ->transform(NumberIn({1e-6, 0.5}))
      ->transform(PercentAsShare())
      ->capture_default_str();
  command
      ->add_option("--within", arguments->within,
                   "time that it may take, by that of its first trials (30s, 2m, 1h); at least 50 trials")
      ->check(ExplainDuration)
      ->capture_default_str();
  command->add_option("--trials", arguments->trials, "so many trials, whatever time they take")
      ->transform(WholeNumberIn(1, 1'000'000));
  command->add_option("--seed", question.seed, "seed of all random streams")
      ->transform(WholeNumberIn(0))
      ->capture_default_str();
  AddFormatOption(command, &arguments->format);
  command->add_option(
      "-o,--out", arguments->out,
      "folder for study.yaml and run.sqlite, created if missing; default: a name made from the "
      "question");
  AddThreadsOption(command, &arguments->threads, "The answer depends on them by the number of trials alone");
  command->callback([arguments] { RunAsk(*arguments); });
}

}  // namespace rcme
