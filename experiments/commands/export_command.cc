#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <set>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/lock_option.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
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

// Returns the problem's id.
std::string ExportTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
                        const TrialData& data, const fs::path& folder, FileInPieces* problems,
                        FileInPieces* truths) {
  RandomStream rng = StreamFor(NameOfTrial(plan, condition, trial), StreamPurpose::kSampling);
  const std::uint32_t seed = SeedForOutside(rng);
  const std::string id = ProblemId(data.problem, seed);
  problems->Write(ProblemAsJson(data.problem, seed));
  truths->Write(TruthAsJson(data, id, condition, trial));
  MatchFile file;
  file.scene = NameOfCondition(plan, condition);
  file.matches = data.problem.matches;
  file.assumed_sigma_px = data.problem.sigma_px;
  for (const double scale : data.problem.noise_scale) file.sigma_px.push_back(scale * data.problem.sigma_px);
  file.camera1 = data.problem.camera1;
  file.camera2 = data.problem.camera2;
  file.prior = data.problem.prior;
  WriteMatchFile(file, (folder / "matches" / (id + ".csv")).string());
  return id;
}

void Export(const ExportArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  StudyPlan plan = MakePlan(study, arguments.study, PlanEstimators::kNotMade);
  TakeLock(arguments.study, arguments.lock, "", &plan);
  if (plan.NumTrials() > kMaxTrials) {
    throw InputError(fmt::format("{}: {} trials are too many to export; at most {} are allowed (--trials)",
                                 arguments.study, plan.NumTrials(), kMaxTrials));
  }
  const fs::path folder = arguments.out;
  MakeResultFolder((folder / "matches").string());
  FileInPieces problems((folder / "problems.jsonl").string()), truths((folder / "truth.jsonl").string());
  std::int64_t num_problems = 0;
  std::set<std::string> ids;
  for (const Condition& condition : plan.conditions) {
    for (std::uint32_t trial = 0; trial < static_cast<std::uint32_t>(condition.num_trials); ++trial) {
      const auto simulated = SimulateDraw(
          plan.study, [&] { return condition.source->Make(NameOfScene(plan, condition, trial)); });
      if (!simulated.made) continue;
      ++num_problems;
      ids.insert(ExportTrial(plan, condition, trial, *simulated.made, folder, &problems, &truths));
    }
  }
  problems.Finish();
  truths.Finish();
  RemoveOthers(folder, ids, !plan.lock.empty());
  WriteFileWhole((folder / "study.yaml").string(), plan.study_yaml);
  if (!plan.lock.empty()) WriteFileWhole((folder / "study.lock").string(), plan.lock);
  PrintMessage(
      "done: {} problems in {}{}; next: answer them, then rcme import ANSWERS --study {} --label mine --out "
      "run.sqlite\n",
      num_problems, (folder / "problems.jsonl").string(),
      num_problems < plan.NumTrials()
          ? fmt::format(" ({} trials cannot be simulated)", plan.NumTrials() - num_problems)
          : "",
      (folder / "study.yaml").string());
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
  rcme export studies/failure_vs_outliers.yaml --trials 100 --out problems
  python3 mine.py < problems/problems.jsonl > answers.jsonl
  rcme import answers.jsonl --study problems/study.yaml --label mine --out run.sqlite)");
  auto arguments = std::make_shared<ExportArguments>();
  AddStudyArgument(command, &arguments->study);
  command->add_option("-o,--out", arguments->out, "folder to write, created if missing")->required();
  AddStudyOptions(command, &arguments->changes);
  AddLockOptions(command, &arguments->lock);
  command->add_option("--trials", arguments->trials, "trials per condition")
      ->transform(WholeNumberIn(1, 2'000'000'000));
  command->callback([arguments] { Export(*arguments); });
}

}  // namespace rcme
