#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "estimator/conform/conform_estimator.h"
#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/estimator_run_options.h"
#include "experiments/commands/estimator_source.h"
#include "experiments/conform/calibration_work.h"
#include "experiments/conform/conform_output.h"
#include "experiments/conform/conform_words.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/work/stop_request.h"
#include "experiments/study/estimator_file.h"
#include "experiments/study/study_plan.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

constexpr int kShiftIsNoticed = 1;  // exit code

struct ConformArguments : EstimatorRunArguments {
  std::string check, models, format = "table";
  std::string new_problem = "usual";
  bool is_needs = false, is_by_strata = false;
  ConformPromise promise;
};

EstimatorSpec ChooseEstimator(const ConformArguments& arguments, const Study& study) {
  if (!arguments.check.empty()) {
    if (!arguments.estimator.empty())
      throw InputError(
          "conform: --check names a file that says which estimator it is of; leave --estimator out");
    std::vector<EstimatorSpec> chosen = {LoadConformedEstimator(arguments.check)};
    if (arguments.changes.allow_process) AllowAndSay(&chosen);
    return chosen.front();
  }
  return FindOnlyEstimator(study, "conform", arguments.estimator, arguments.changes.allow_process);
}

StudyPlan MakeCalibrationPlan(const ConformArguments& arguments) {
  Study study = LoadChangedStudy(arguments.study, arguments.changes);
  RequireFixedOptions(study, "a calibration");
  study.estimators = {ChooseEstimator(arguments, study)};
  if (study.estimators.front().name == kConformEstimator)
    throw InputError("conform: the estimator is conformed already; to test its file give --check FILE");
  if (arguments.trials > 0) study.trials = static_cast<int>(arguments.trials);
  if (!arguments.check.empty()) {  // wrong is what the file calls wrong
    const ConformRule rule = ReadConformFile(arguments.check).rule;
    study.failure = {rule.max_rotation_error_deg, rule.max_direction_error_deg};
  }
  StudyPlan plan = MakePlan(study, arguments.study);
  RequireUnweighted(plan, "conform");
  return plan;
}

NewProblem ChosenNewProblem(const ConformArguments& arguments, const StudyPlan& plan) {
  if (arguments.new_problem == "trial") return NewProblem::kTrial;
  if (arguments.new_problem == "condition") return NewProblem::kCondition;
  return UsualNewProblem(plan);
}

ConformReport Calibrate(const ConformArguments& arguments, const StudyPlan& plan, NewProblem new_problem,
                        const AnswerRows& answers) {
  const std::optional<ConformRule> models = LoadModels(plan, arguments.models);
  ConformReport report =
      CalibrateConform(plan, new_problem, arguments.promise, models ? &*models : nullptr, answers);
  WriteFileWhole(arguments.out, ConformFileText(report.rule, DescribePromises(report.rule)));
  return report;
}

bool IsSameFile(const std::string& a, const std::string& b) {
  std::error_code ignored;
  return !a.empty() && !b.empty() && std::filesystem::equivalent(a, b, ignored);
}

void RequireArguments(const ConformArguments& arguments) {
  if (arguments.study.empty()) throw InputError("conform: a study is missing, or --needs");
  if (arguments.check.empty() && arguments.out.empty())
    throw InputError("conform: --out is missing; give the file to be written");
  for (const std::string& input : {arguments.study, arguments.check, arguments.models}) {
    if (IsSameFile(input, arguments.out))
      throw InputError(fmt::format("conform: --out {} would replace a file that is read", arguments.out));
  }
}

// Returns nullopt if this was the part of a shard, which is then done.
std::optional<AnswerRows> GetAnswers(const ConformArguments& arguments, const StudyPlan& plan,
                                     NewProblem new_problem, Runner* runner) {
  if (!runner->ReadsParts()) {
    CheckProcessEstimators(plan.study.estimators);
    GetCalibration(plan, runner);
  }
  if (!arguments.shards.shard.empty()) {
    PrintPartIsDone(runner->shard(), arguments.out);
    return std::nullopt;
  }
  RequireWhole(*runner);
  return ReadCalibration(plan, new_problem, *runner);
}

void Conform(const ConformArguments& arguments) {
  if (arguments.is_needs) {
    fmt::print("{}", DescribeNeeds(arguments.promise));
    return;
  }
  RequireArguments(arguments);
  const StopOnSignals stop;
  StartTimeLimit(arguments.shards.max_time);
  const StudyPlan plan = MakeCalibrationPlan(arguments);
  const bool is_check = !arguments.check.empty();
  std::optional<ConformRule> checked;
  if (is_check) checked = LoadToCheck(plan, arguments.check);
  const NewProblem new_problem =
      checked && checked->origin.new_groups ? NewProblem::kCondition : ChosenNewProblem(arguments, plan);
  LoadModels(plan, arguments.models);  // refuses before any trial
  Runner runner =
      MakeRunner(PlanCalibration(plan), arguments.shards, arguments.out,
                 arguments.out.empty() ? "" : FindCheckpointBeside(arguments.out), arguments.threads);
  const std::optional<AnswerRows> answers = GetAnswers(arguments, plan, new_problem, &runner);
  if (!answers) return;
  const ConformReport report =
      checked ? CheckConform(plan, *checked, *answers) : Calibrate(arguments, plan, new_problem, *answers);
  PrintResult(MakeConformResult(report, arguments.is_by_strata), arguments.format,
              is_check ? arguments.out : "");
  runner.RemoveCheckpoint();
  const bool is_broken = report.kept && report.kept->IsAnyRefuted();
  if (is_broken || (report.shift && report.shift->noticed_after)) throw EndWith{kShiftIsNoticed};
}

}  // namespace

void AddConformCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("conform", "Make an estimator keep its word, by problems whose truth is known");
  command->footer(R"(Runs one estimator on the problems of a study (simulated ones, your own pairs with their
truth, or a twin of your pairs) and writes a file with what they teach:

  region       factors that make its covariance contain the truth as often as promised, also
               among the answers that look hardest (split conformal prediction)
  probability  that an answer is wrong, from what can be seen of it
  accept rule  which answers to refuse so that few are wrong and accepted (learn then test)
  familiarity  whether a new problem is like those of the calibration

A study, `rcme estimate`, Python and the robot's header take the file as an estimator:
{conform: FILE} in a study, --conform FILE for `rcme estimate`.

Prints what such rules do for answers that they have not seen (cross-validation), beside the
stated covariance and plain conformal regions. The promises hold for problems exchangeable
with those of the study. Of a population of conditions, and of several real scenes, a new
problem is of a new condition or scene, and these are what is counted; --new trial promises
for the same conditions and scenes alone.

With --check FILE the study has new problems: how the file does on them, whether its promises
hold there (tested at level 2.5 %) and whether the problems look like those of its calibration
(at level 5 %). Exit code: 1 if a promise does not hold or a shift is noticed, else 0; 2: wrong
input.

Examples:
  rcme conform --needs --wrong-and-accepted 0.01
  rcme conform own_camera --estimator standard --by-strata --out mine.conform.json
  rcme conform own_camera --estimator rcme_calibrated --out mine.conform.json
  rcme conform pairs.yaml --estimator opencv_magsac --level 0.9 --out mine.conform.json
  rcme conform pairs.yaml --models simulated.conform.json --out mine.conform.json
  rcme conform new_pairs.yaml --check mine.conform.json
  rcme estimate matches.csv.gz --conform mine.conform.json)");
  auto arguments = std::make_shared<ConformArguments>();
  AddStudyAndEstimator(command, arguments.get());
  command->add_option("-o,--out", arguments->out,
                      "the file to be written; with --check the report, instead of standard output");
  command->add_option("--check", arguments->check, "an earlier file, to be tested on the study's problems");
  command
      ->add_option(
          "--models", arguments->models,
          "a file of `rcme conform`, of simulated problems for example, whose models of difficulty and "
          "failure are taken: then all answers set promises and none trains models")
      ->excludes("--check");
  command->add_option("--level", arguments->promise.level, "probability that a region contains the truth")
      ->transform(NumberIn({0.51, 0.999}))
      ->capture_default_str();
  command
      ->add_option("--wrong-and-accepted", arguments->promise.wrong_and_accepted,
                   "greatest probability that an answer is wrong and accepted")
      ->transform(NumberIn({1e-4, 0.5}))
      ->capture_default_str();
  command
      ->add_option("--risk", arguments->promise.risk,
                   "probability that the accept rule does not keep its promise")
      ->transform(NumberIn({1e-4, 0.5}))
      ->capture_default_str();
  command
      ->add_option("--new", arguments->new_problem,
                   "what a new problem is: another trial of these conditions, one of another condition (or "
                   "scene), or the usual of these for the study")
      ->check(MakeChoiceValidator({"usual", "trial", "condition"}))
      ->capture_default_str();
  command->add_flag("--needs", arguments->is_needs, "print how many answers the promises need, and end");
  command->add_flag(
      "--by-strata", arguments->is_by_strata,
      "also coverage and size by quarters of what is visible of an answer (matches, parallax over "
      "its noise, planarity, stated sd and probability), in table and json");
  AddTrialsOption(command, arguments.get());
  AddFormatOption(command, &arguments->format);
  AddRunOptions(command, arguments.get());
  command->callback([arguments] { Conform(*arguments); });
}

}  // namespace rcme
