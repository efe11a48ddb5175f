#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/common_options.h"
#include "experiments/commands/study_source.h"
#include "experiments/core/files/file_output.h"
#include "experiments/core/text/message.h"
#include "experiments/real/answer/why.h"
#include "experiments/run/store/result_store.h"
#include "experiments/statistics/trial_output.h"
#include "experiments/statistics/trial_program.h"
#include "experiments/study/absent_python.h"
#include "experiments/trial/trial_columns.h"
#include "experiments/trial/trial_event.h"
#include "parameters/input_error.h"
#include "parameters/plain_text.h"
#include "stats/constants.h"

namespace rcme {
namespace {

std::string MatrixText(const Eigen::MatrixXd& matrix) {
  std::string text;
  for (Eigen::Index r = 0; r < matrix.rows(); ++r) {
    text += "    ";
    for (Eigen::Index c = 0; c < matrix.cols(); ++c) text += fmt::format("{:>14.6g}", matrix(r, c));
    text += "\n";
  }
  return text;
}

std::string PoseText(const RelativePose& pose) {
  return fmt::format("  R =\n{}  t =\n{}", MatrixText(pose.R), MatrixText(pose.t.transpose()));
}

void PrintData(const StudyPlan& plan, const Condition& condition, std::uint32_t trial,
               const TrialData& data) {
  fmt::print("Study {}, seed {}, condition {}, trial {} ({})\n", plan.study.name, plan.study.seed,
             condition.index, trial, data.origin);
  for (size_t f = 0; f < plan.factor_names.size(); ++f) {
    fmt::print("  {} = {}\n", plan.factor_names[f], condition.levels[f]);
  }
  fmt::print("  {} matches, sigma {} px\n", data.problem.matches.size(), data.problem.sigma_px);
  if (data.truth.cam2_from_cam1_true)
    fmt::print("True motion\n{}", PoseText(*data.truth.cam2_from_cam1_true));
}

void PrintNumbers(const TrialRecord& record) {
  VisitColumns(record, [](const StoredColumn& column, const auto& field) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, MotionStatus>) {
      if (column.role != StoredColumn::Role::kKey)
        fmt::print("  {:<26}{}\n", column.name, FormatField(field));
    }
  });
}

void PrintEstimate(const std::string& label, const MotionEstimate& estimate, const TrialRecord& record,
                   const FailureBounds& bounds) {
  fmt::print("\n{}: {} ({})\n  {}\n", label, StatusName(estimate.status),
             Name(ClassifyOutcome(record, bounds)), estimate.message);
  const bool is_in_doubt = record.status == MotionStatus::kTruthInDoubt;
  if (is_in_doubt ? estimate.status == MotionStatus::kOk : !HasRefused(record)) {
    fmt::print("{}  standard deviations [rotation, direction] (deg)\n{}", PoseText(estimate.cam2_from_cam1),
               MatrixText(kDegPerRad * estimate.pose_cov.diagonal().cwiseSqrt().transpose()));
  }
  PrintNumbers(record);
}

// Of a function of Python: what the file says.
void PrintStored(const std::string& label, const MotionEstimate& absent, const TrialRecord* stored,
                 const FailureBounds& bounds) {
  fmt::print("\n{}: {}\n", label, absent.message);
  if (stored == nullptr) return fmt::print("  not run yet\n");
  fmt::print("  its record in the file: {}\n", OutcomeInFull(*stored, bounds));
  PrintNumbers(*stored);
}

struct ReplayArguments {
  std::string run;
  std::uint32_t condition = 0, trial = 0;
  bool allow_process = false;
  std::string cpp, estimator;  // file of --emit-cpp, and the label of its estimator; empty: the most telling
};

void EmitCpp(const StudyPlan& plan, const Condition& condition, const TrialResult& result,
             const ReplayArguments& arguments) {
  const std::vector<EstimatorSpec>& specs = plan.study.estimators;
  auto chosen = specs.begin() + static_cast<std::ptrdiff_t>(MostTelling(plan, result));
  if (!arguments.estimator.empty())
    chosen = std::ranges::find(specs, arguments.estimator, &EstimatorSpec::label);
  if (chosen == specs.end()) {
    throw InputError(fmt::format("--estimator: {} is not an estimator of the run; it has: {}",
                                 Quoted(arguments.estimator), fmt::join(ListLabels(specs), ", ")));
  }
  WriteFileWhole(arguments.cpp,
                 TrialAsCpp(plan, condition, result, static_cast<size_t>(chosen - specs.begin())));
  PrintMessage("{}: a program that calls {} on this problem; how to build it stands at its top\n",
               arguments.cpp, chosen->label);
}

void Replay(const ReplayArguments& arguments) {
  const std::string& run = arguments.run;
  const std::uint32_t condition_index = arguments.condition, trial = arguments.trial;
  const ResultStore store = ResultStore::OpenForReading(run);
  const StudyPlan plan = PlanOfStored(store, arguments.allow_process);
  const Condition& condition = ChosenCondition(plan, condition_index);
  const std::vector<TrialRecord> stored = store.ReadTrialRecords(condition_index, trial);
  if (stored.empty()) {
    PrintMessage(
        "{}: no trial {} of condition {} is in the file, which asks for {} of it; made from the study\n", run,
        trial, condition_index, store.Description().conditions[condition_index].num_trials);
  }
  const TrialResult result = RunTrial(plan, condition, trial);
  PrintData(plan, condition, trial, result.data);
  for (size_t e = 0; e < result.records.size(); ++e) {
    const EstimatorSpec& spec = plan.study.estimators[e];
    const TrialRecord* in_file = e < stored.size() ? &stored[e] : nullptr;
    if (spec.name == kPythonEstimator) {
      PrintStored(spec.label, result.estimates[e], in_file, plan.study.failure);
      continue;
    }
    PrintEstimate(spec.label, result.estimates[e], result.records[e], plan.study.failure);
    const char* verdict = in_file == nullptr                                ? "not run yet"
                          : AreEqualButForTime(*in_file, result.records[e]) ? "the same"
                                                                            : "DIFFERENT";
    fmt::print("  the record in the file:   {}\n", verdict);
  }
  fmt::print("{}", WhyAsText(plan, result));
  if (!arguments.cpp.empty()) EmitCpp(plan, condition, result, arguments);
}

}  // namespace

void AddReplayCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("replay", "Run one trial of a result file again and print it in full");
  command->footer(R"(Says for each estimator whether the record in the file is the same, and why an answer is
wrong. A trial beyond those of the run is made from its study.

--emit-cpp writes a C++ program that calls one estimator on the same problem with the
same samples, with nothing of the study around it: for a debugger.

Examples:
  rcme failures run.sqlite                                 which trials to look at
  rcme replay run.sqlite --condition 6 --trial 17
  rcme replay run.sqlite --condition 6 --trial 17 --emit-cpp trial.cc --estimator standard)");
  auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  AddTrialChoice(command, &arguments->condition, &arguments->trial);
  CLI::Option* cpp =
      command->add_option("--emit-cpp", arguments->cpp, "also write a C++ program of one estimator's call");
  command
      ->add_option("--estimator", arguments->estimator,
                   "label of the estimator of --emit-cpp; default: the first that failed or refused")
      ->needs(cpp);
  AddProcessOption(command, &arguments->allow_process);
  command->callback([arguments] { Replay(*arguments); });
}

}  // namespace rcme
