#include <fmt/format.h>
#include <fmt/ranges.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/core/text/shell_word.h"
#include "experiments/core/work/for_each_index.h"
#include "experiments/core/work/progress.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/data/match_file.h"
#include "experiments/study/study_file.h"
#include "experiments/trial/simulate_draw.h"
#include "parameters/input_error.h"
#include "peers/answer_json.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// Every trial writes one file into the same folder; more would strain file systems.
constexpr std::int64_t kMaxTrials = 1'000'000;

struct ExportArguments {
  std::string study, out;
  StudyChanges changes;
  LockArguments lock;
  std::int64_t trials = 0;  // the study's own
  int threads = 0;
};

// What an estimator must not see.
std::string TruthAsJson(const TrialData& data, const std::string& id, const Condition& condition,
                        std::uint32_t trial) {
  nlohmann::ordered_json json = {{"id", id}, {"condition", condition.index}, {"trial", trial}};
  const Truth& truth = data.truth;
  const auto list = [](const Eigen::MatrixXd& m) {
    return std::vector<double>(m.data(), m.data() + m.size());
  };
  if (truth.cam2_from_cam1_true) {
    json["R"] = list(truth.cam2_from_cam1_true->R.transpose());  // row after row
    if (truth.is_direction_known) json["t"] = list(truth.cam2_from_cam1_true->t);
  }
  if (!truth.is_inlier_true.empty()) json["is_inlier"] = truth.is_inlier_true;
  return json.dump() + "\n";
}

constexpr size_t kMaxSceneBytes = 200;  // of match files (data/match_file.cc)

// "outlier_ratio 0.3, sigma_px 0.5": the levels of a condition, or its number if they are too long; without
// factors the study's name.
std::string NameOfCondition(const StudyPlan& plan, const Condition& condition) {
  std::vector<std::string> parts;
  for (size_t f = 0; f < condition.levels.size(); ++f)
    parts.push_back(fmt::format("{} {}", plan.factor_names[f], condition.levels[f]));
  const std::string name = parts.empty() ? plan.study.name : fmt::format("{}", fmt::join(parts, ", "));
  return name.size() <= kMaxSceneBytes ? name : fmt::format("condition {}", condition.index);
}

// Removes the match files and the lock of an earlier export into the folder.
void RemoveOthers(const fs::path& folder, const std::set<std::string>& ids, bool has_lock) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder / "matches")) {
    const std::string id = entry.path().stem().string();
    const bool is_ours = id.size() == 16 && id.find_first_not_of("0123456789abcdef") == std::string::npos &&
                         entry.path().extension() == ".csv";
    if (is_ours && !ids.contains(id)) fs::remove(entry.path());
  }
  if (!has_lock) fs::remove(folder / "study.lock");
}

// A problem and its truth as lines of JSON; all are empty if the trial cannot be simulated.
struct ExportedTrial {
  std::string id, problem, truth;
};

// Writes the trial's match file.
ExportedTrial ExportTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                          const fs::path& folder) {
  const auto simulated =
      SimulateDraw(plan.study, [&] { return condition.source->Make(NameOfScene(plan, condition, trial)); });
  if (!simulated.made) return {};
  const TrialData& data = *simulated.made;
  RandomStream rng = StreamFor(NameOfTrial(plan, condition, trial), StreamPurpose::kSampling);
  const std::uint32_t seed = SeedForOutside(rng);
  const std::string id = ProblemId(data.problem, seed);
  MatchFile file;
  file.scene = NameOfCondition(plan, condition);
  file.matches = data.problem.matches;
  file.assumed_sigma_px = data.problem.sigma_px;
  for (const double scale : data.problem.noise_scale) file.sigma_px.push_back(scale * data.problem.sigma_px);
  file.camera1 = data.problem.camera1;
  file.camera2 = data.problem.camera2;
  file.prior = data.problem.prior;
  WriteMatchFile(file, (folder / "matches" / (id + ".csv")).string());
  return {id, ProblemAsJson(data.problem, seed), TruthAsJson(data, id, condition, trial)};
}

// Writes the problems, in the order of the plan, and their match files. Returns the ids of the problems.
std::vector<std::string> ExportTrials(const StudyPlan& plan, int num_threads, const fs::path& folder) {
  FileInPieces problems((folder / "problems.jsonl").string()), truths((folder / "truth.jsonl").string());
  std::vector<std::string> ids;
  std::atomic<std::int64_t> num_files = 0;
  Progress progress("trials", plan.NumTrials());
  try {
    for (const Condition& condition : plan.conditions) {
      const auto make = [&](std::int64_t trial) {
        ExportedTrial exported = ExportTrial(plan, condition, static_cast<std::uint32_t>(trial), folder);
        num_files += !exported.id.empty();
        return exported;
      };
      MakeInOrder(condition.num_trials, num_threads, make, [&](const ExportedTrial& exported) {
        progress.Advance(1);
        if (exported.id.empty()) return;
        ids.push_back(exported.id);
        problems.Write(exported.problem);
        truths.Write(exported.truth);
      });
    }
  } catch (const Stopped&) {
    throw Stopped(fmt::format(
        "export: stopped; {} match files of {} trials are in {}; the other files were not written; "
        "the same command writes all of them",
        num_files.load(), plan.NumTrials(), (folder / "matches").string()));
  }
  problems.Finish();
  truths.Finish();
  return ids;
}

void Export(const ExportArguments& arguments) {
  const StopOnSignals stop;
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  StudyPlan plan = MakePlan(study, arguments.study, PlanEstimators::kNotMade);
  TakeLock(arguments.study, arguments.lock, "", &plan);
  if (plan.NumTrials() > kMaxTrials) {
    throw InputError(fmt::format("{}: {} trials are too many to export; at most {} are allowed (--trials)",
                                 arguments.study, plan.NumTrials(), kMaxTrials));
  }
  const fs::path folder = arguments.out;
  CheckIsNoInput((folder / "study.yaml").string(), {arguments.study});
  MakeResultFolder((folder / "matches").string());
  const std::vector<std::string> ids = ExportTrials(plan, arguments.threads, folder);
  RemoveOthers(folder, {ids.begin(), ids.end()}, !plan.lock.empty());
  WriteFileWhole((folder / "study.yaml").string(),
                 plan.lock.empty() ? ToYaml(WithAbsolutePaths(plan.study)) : plan.study_yaml);
  if (!plan.lock.empty()) WriteFileWhole((folder / "study.lock").string(), plan.lock);
  PrintMessage(
      "done: {} problems in {}{}; next: answer them, then rcme import ANSWERS --study {} --label mine --out "
      "run.sqlite\n",
      ids.size(), (folder / "problems.jsonl").string(),
      std::ssize(ids) < plan.NumTrials()
          ? fmt::format(" ({} trials cannot be simulated)", plan.NumTrials() - std::ssize(ids))
          : "",
      QuoteForShell((folder / "study.yaml").string()));
}

}  // namespace

void AddExportCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "export", "Write the problems of a study, and separately their truth, for an estimator elsewhere");
  command->footer(R"(Files that it writes:
  FOLDER/problems.jsonl   a problem per line, as an estimator {process: ...} gets it
  FOLDER/matches/ID.csv   the same problems as match files for `rcme estimate`
  FOLDER/truth.jsonl      the motion and the true matches by id; not for the estimator
  FOLDER/study.yaml       the study as it was exported, for `rcme import`
  FOLDER/study.lock       its lock, if it has one (`rcme lock`)

Examples:
  rcme export failure_vs_outliers --trials 100 --out problems
  python3 mine.py < problems/problems.jsonl > answers.jsonl
  rcme import answers.jsonl --study problems/study.yaml --label mine --out run.sqlite)");
  auto arguments = std::make_shared<ExportArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option("-o,--out", arguments->out, "folder to write, created if missing")->required();
  AddStudyOptions(command, &arguments->changes);
  AddLockOptions(command, &arguments->lock);
  command->add_option("--trials", arguments->trials, "trials per condition")
      ->transform(WholeNumberIn(1, 2'000'000'000));
  AddThreadsOption(command, &arguments->threads);
  command->callback([arguments] { Export(*arguments); });
}

}  // namespace rcme
