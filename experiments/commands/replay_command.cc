#include <fmt/format.h>

#include <memory>

#include "experiments/commands/commands.h"
#include "experiments/commands/number_option.h"
#include "experiments/commands/process_option.h"
#include "experiments/commands/study_source.h"
#include "experiments/real/answer/why.h"
#include "experiments/run/store/result_store.h"
#include "experiments/trial/trial_columns.h"
#include "experiments/trial/trial_outcome.h"
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

void PrintEstimate(const std::string& label, const MotionEstimate& estimate, const TrialRecord& record,
                   const FailureBounds& bounds) {
  fmt::print("\n{}: {} ({})\n  {}\n", label, StatusName(estimate.status), Name(OutcomeOf(record, bounds)),
             estimate.message);
  if (!HasRefused(record)) {
    fmt::print("{}  standard deviations [rotation, direction] (deg)\n{}", PoseText(estimate.cam2_from_cam1),
               MatrixText(kDegPerRad * estimate.pose_cov.diagonal().cwiseSqrt().transpose()));
  }
  VisitColumns(record, [](const StoredColumn& column, const auto& field) {
    if constexpr (!std::is_same_v<std::decay_t<decltype(field)>, MotionStatus>) {
      if (column.role != StoredColumn::Role::kKey)
        fmt::print("  {:<26}{}\n", column.name, FormatField(field));
    }
  });
}

// Whether two records agree in every field but the time.
bool AreEqual(const TrialRecord& a, const TrialRecord& b) {
  const auto text_of = [](const TrialRecord& record) {
    std::string text;
    VisitColumns(record, [&](const StoredColumn& column, const auto& field) {
      if (column.role != StoredColumn::Role::kTime) text += FormatField(field) + " ";
    });
    return text;
  };
  return text_of(a) == text_of(b);
}

struct ReplayArguments {
  std::string run;
  std::uint32_t condition = 0, trial = 0;
  bool allow_process = false;
};

void Replay(const ReplayArguments& arguments) {
  const auto& [run, condition_index, trial, allow_process] = arguments;
  const ResultStore store = ResultStore::OpenForReading(run);
  const StudyPlan plan = PlanOfStored(store, allow_process);
  const Condition& condition = ChosenCondition(plan, condition_index);
  const std::vector<TrialRecord> stored = store.RecordsOf(condition_index, trial);
  const TrialResult result = RunTrial(plan, condition, trial);
  PrintData(plan, condition, trial, result.data);
  for (size_t e = 0; e < result.records.size(); ++e) {
    PrintEstimate(plan.study.estimators[e].label, result.estimates[e], result.records[e], plan.study.failure);
    const bool is_stored = e < stored.size();
    fmt::print("  the record in the file:   {}\n", !is_stored                               ? "not run yet"
                                                   : AreEqual(stored[e], result.records[e]) ? "the same"
                                                                                            : "DIFFERENT");
  }
  fmt::print("{}", WhyAsText(plan, result));
}

}  // namespace

void AddReplayCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("replay", "Run one trial of a result file again and print it in full");
  auto arguments = std::make_shared<ReplayArguments>();
  command->add_option("run", arguments->run, "result file of `rcme run`")->required();
  command
      ->add_option("--condition", arguments->condition, "condition, from 0 (column condition of the summary)")
      ->transform(WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max()))
      ->required();
  command->add_option("--trial", arguments->trial, "trial, from 0")
      ->transform(WholeNumberIn(0, std::numeric_limits<std::uint32_t>::max()))
      ->required();
  AddProcessOption(command, &arguments->allow_process);
  command->callback([arguments] { Replay(*arguments); });
}

}  // namespace rcme
