
#include <filesystem>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_run_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/integrity/integrity_output.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial_items.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kRiskIsExceeded = 1, kRiskIsUndecided = 3;  // exit codes

struct IntegrityArguments : EstimatorRunArguments {
  IntegrityTerms terms;
  std::string format = "table";
};

StudyPlan MakeIntegrityPlan(const IntegrityArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  RequireFixedOptions(study, "integrity");
  study.estimators = {
      FindOnlyEstimator(study, "integrity", arguments.estimator, arguments.changes.allow_process)};
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  StudyPlan plan = MakePlan(study, arguments.study);
  RequireUnweighted(plan, "integrity");
  return plan;
}

void WriteReport(const CommandResult& result, const std::string& out) {
  MakeResultFolder(out);
  const std::filesystem::path folder(out);
  WriteFileWhole((folder / "integrity.txt").string(), result.text);
  WriteFileWhole((folder / "integrity.json").string(), result.json);
}

void RunIntegrity(const IntegrityArguments& arguments) {
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  const StudyPlan plan = MakeIntegrityPlan(arguments);
  if (arguments.shards.parts.empty()) CheckProcessEstimators(plan.study.estimators);
  const bool is_part = !arguments.shards.shard.empty();
  if (is_part && arguments.out.empty())
    throw InputError("integrity: --out is missing; give the file of the part");
  if (!is_part && !arguments.out.empty()) MakeResultFolder(arguments.out);
  Runner runner =
      MakeRunner(PlanIntegrity(plan, arguments.terms), arguments.shards, arguments.out,
                 arguments.out.empty() ? "" : FindCheckpointInFolder(arguments.out), arguments.threads);
  if (!runner.ReadsParts()) GetIntegrity(plan, arguments.terms, &runner);
  if (is_part) return PrintPartIsDone(runner.shard(), arguments.out);
  RequireWhole(runner);
  IntegrityReport report{plan.study.name,
                         plan.study.estimators.front().label,
                         arguments.terms,
                         UsualNewProblem(plan),
                         plan.study.common_scenes,
                         plan.factor_names,
                         ReadIntegrity(plan, runner),
                         HasRealScenes(plan)};
  const CommandResult result = MakeIntegrityResult(report);
  PrintResult(result, arguments.format);
  if (!arguments.out.empty()) WriteReport(result, arguments.out);
  runner.RemoveCheckpoint();
  const RiskVerdict verdict = JudgeRisk(report);
  if (verdict == RiskVerdict::kExceeded) throw EndWith{kRiskIsExceeded};
  if (verdict == RiskVerdict::kUndecided) throw EndWith{kRiskIsUndecided};
}

}  // namespace

void AddIntegrityCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "integrity", "Count errors beyond their protection level, and how often a level is of use");
  command->footer(R"(Runs one estimator on the problems of a study. Each answer has two protection levels: the
angles that its errors of rotation and of direction exceed with a probability of at most
--risk, by the covariance and the probability of failure that the answer states. An
answer is available if its level is within the alert limit.

  misleading   the error is beyond the level: of the answers at most the risk should be
  hazardous    the error is beyond the alert limit, and the level is not

The row `either` counts trials that are misleading or hazardous in rotation or in direction.

Prints their rates with exact intervals, over all trials and for each condition. With --out
DIR they are in DIR/integrity.txt too, and in DIR/integrity.json with the counts of the
Stanford diagram. Only counts are kept, so that millions of trials need no room. If the
command is stopped, run it again: it goes on.

Exit code, over all trials: 0 if the risk is kept for rotation and direction, 1 if it is
exceeded for one of them, 3 if that is undecided: there are too few answers, or none. To
show that a risk of 0.001 is kept takes at least 3,688 answers, of 0.01 at least 368. With
an estimator that keeps its risk the exit code is 1 with probability at most 5 %. 2: wrong
input.

Examples:
  rcme integrity own_camera --estimator rcme_calibrated --trials 5000 --out integrity
  rcme integrity own_camera --estimator opencv_magsac --risk 0.01 --rotation-limit 2
  rcme plot stanford integrity/integrity.json --out stanford
  rcme integrity STUDY --shard 3/64 --out parts/3.json          the share of one machine
  rcme integrity STUDY --merge parts/*.json --out integrity     the bytes of a single run)");
  auto arguments = std::make_shared<IntegrityArguments>();
  AddStudyAndEstimator(command, arguments.get())->required();
  command
      ->add_option("--risk", arguments->terms.risk,
                   "probability that an error exceeds its protection level, of rotation and of direction")
      ->transform(NumberIn({1e-9, 0.5}))
      ->capture_default_str();
  command
      ->add_option("--rotation-limit", arguments->terms.rotation_limit_deg,
                   "alert limit of the rotation, deg")
      ->transform(NumberIn({1e-4, 180.0}))
      ->capture_default_str();
  command
      ->add_option("--direction-limit", arguments->terms.direction_limit_deg,
                   "alert limit of the direction of translation, deg")
      ->transform(NumberIn({1e-4, 180.0}))
      ->capture_default_str();
  command->add_option("-o,--out", arguments->out,
                      "folder for the results; it is made. With --shard the file of the part");
  AddFormatOption(command, &arguments->format);
  AddTrialsOption(command, arguments.get());
  AddRunOptions(command, arguments.get());
  command->callback([arguments] { RunIntegrity(*arguments); });
}

}  // namespace rcme
