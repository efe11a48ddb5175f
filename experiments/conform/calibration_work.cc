#include "experiments/conform/calibration_work.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "experiments/trial/covariance_score.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/truth_error.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kTrialsOfItem = 50;
constexpr size_t kNumbersBeforeFeatures = 7, kNumbersOfRow = kNumbersBeforeFeatures + kNumVisibleFeatures;

double LogDeterminant(const Matrix5d& covariance) {
  const Eigen::LDLT<Matrix5d> ldlt(covariance);
  return ldlt.vectorD().array().max(0.0).log().sum();
}

// Sets the two fields for the error of the truth (answer_row.h).
void AddTruthError(const FailureBounds& bounds, const TrialRecord& record, const Truth& truth,
                   AnswerRow* row) {
  if (!truth.sd) return;
  row->nees_of_inexact_truth = std::isnan(record.nees) ? kInfinity : record.nees;
  const TruthErrorDeg truth_error = ComputeTruthErrorDeg(truth);
  const auto is_wrong = [&](double moved) {
    return record.rotation_error_deg + moved * truth_error.rotation > bounds.max_rotation_error_deg ||
           record.direction_error_deg + moved * truth_error.direction > bounds.max_direction_error_deg;
  };
  row->is_wrong_by_truth = is_wrong(-1.0) != is_wrong(1.0);
}

// Fills `row` if the trial has an answer with a known error (kAnswer).
enum class AnswerKind { kAnswer, kRefusal, kUnscored };
AnswerKind MakeRow(const FailureBounds& bounds, const TrialResult& result, AnswerRow* row) {
  const TrialRecord& record = result.records.front();
  if (!IsCounted(record)) return AnswerKind::kUnscored;
  if (HasRefused(record)) return AnswerKind::kRefusal;
  const MotionEstimate& estimate = result.estimates.front();
  row->features = MeasureVisibleFeatures(result.data.problem, estimate);
  row->is_wrong = HasFailed(record, bounds);
  row->nees = row->max_error_deg = row->log_det = kInfinity;
  if (IsInvalid(record)) return AnswerKind::kAnswer;
  if (!result.data.truth.cam2_from_cam1_true || !result.data.truth.is_direction_known)
    return AnswerKind::kUnscored;
  const double nees = NormalizedErrorOfPose(estimate.cam2_from_cam1, estimate.pose_cov,
                                            *result.data.truth.cam2_from_cam1_true);
  row->nees = std::isnan(nees) ? kInfinity : nees;
  row->max_error_deg = std::max(record.rotation_error_deg, record.direction_error_deg);
  row->log_det = LogDeterminant(estimate.pose_cov);
  AddTruthError(bounds, record, result.data.truth, row);
  return AnswerKind::kAnswer;
}

// [trial, wrong, nees, error, log det, nees with the truth's error, wrong or not by the truth, features ...]
Json RowAsJson(std::uint32_t trial, const AnswerRow& row) {
  std::vector<double> numbers = {
      static_cast<double>(trial), row.is_wrong ? 1.0 : 0.0,         row.nees, row.max_error_deg, row.log_det,
      row.nees_of_inexact_truth,  row.is_wrong_by_truth ? 1.0 : 0.0};
  numbers.insert(numbers.end(), row.features.begin(), row.features.end());
  return NumbersAsJson(numbers);
}

// [[refused trials], number without truth, [rows]]
std::string ComputeAnswers(const StudyPlan& plan, const Condition& condition, const TrialRange& trials) {
  std::int64_t num_unscored = 0;
  Json refused = Json::array(), rows = Json::array();
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    AnswerRow row;
    const AnswerKind outcome = MakeRow(plan.study.failure, RunTrialOfDraw(plan, condition, trial), &row);
    num_unscored += outcome == AnswerKind::kUnscored;
    if (outcome == AnswerKind::kRefusal) refused.push_back(trial);
    if (outcome == AnswerKind::kAnswer) rows.push_back(RowAsJson(trial, row));
  }
  return Json{std::move(refused), num_unscored, std::move(rows)}.dump();
}

void Require(bool holds) {
  if (!holds) throw std::invalid_argument("no trial gives such numbers");
}

AnswerRow RowFrom(const std::vector<double>& numbers) {
  AnswerRow row;
  row.is_wrong = numbers[1] == 1.0;
  row.nees = numbers[2];
  row.max_error_deg = numbers[3];
  row.log_det = numbers[4];
  row.nees_of_inexact_truth = numbers[5];
  row.is_wrong_by_truth = numbers[6] == 1.0;
  std::copy(numbers.begin() + kNumbersBeforeFeatures, numbers.end(), row.features.begin());
  Require((row.is_wrong_by_truth || numbers[6] == 0.0) && !(row.nees_of_inexact_truth < 0.0) &&
          (row.is_wrong || numbers[1] == 0.0) && row.nees >= 0.0 && row.max_error_deg >= 0.0 &&
          !std::isnan(row.log_det));
  return row;
}

void ReadPiece(const StudyPlan& plan, const TrialGrouping& grouping, const ItemPlace& place,
               const std::string& json, AnswerRows* all) {
  const Condition& condition = plan.conditions[place.group];
  const TrialRange trials = FindTrialsOfItem(plan, place, kTrialsOfItem);
  const std::int64_t most = trials.end - trials.first;
  const Json piece = ParsePiece(json);
  RequireSize(piece, 3);
  Require(piece[0].is_array() && piece[2].is_array() &&
          static_cast<std::int64_t>(piece[0].size() + piece[2].size()) <= most);
  const auto group_of = [&](double trial) {
    Require(trial >= trials.first && trial < trials.end);
    return grouping.FindGroup(condition, static_cast<std::uint32_t>(trial));
  };
  std::map<std::int64_t, AskedProblem> by_trial;
  for (const Json& entry : piece[0]) {
    const std::int64_t trial = CountFrom(entry, trials.end);
    by_trial[trial] = {group_of(static_cast<double>(trial)), true};
  }
  all->num_unscored += CountFrom(piece[1], most);
  for (const Json& entry : piece[2]) {
    RequireSize(entry, kNumbersOfRow);
    const std::vector<double> numbers = NumbersFrom(entry);
    AnswerRow& row = all->rows.emplace_back(RowFrom(numbers));
    row.group = group_of(numbers[0]);
    by_trial[static_cast<std::int64_t>(numbers[0])] = {row.group, false};
  }
  // In the order of the trials: the first problem of a group is then refused as often as any other.
  for (const auto& [trial, problem] : by_trial) all->problems.push_back(problem);
}

}  // namespace

WorkPlan PlanCalibration(const StudyPlan& plan) {
  return PlanTrialItems(plan, "conform", kTrialsOfItem, "conform 2\n");
}

void GetCalibration(const StudyPlan& plan, Runner* runner) {
  GetTrialItems(
      plan, kTrialsOfItem,
      [&](const Condition& condition, const TrialRange& trials) {
        return ComputeAnswers(plan, condition, trials);
      },
      runner);
}

AnswerRows ReadCalibration(const StudyPlan& plan, NewProblem new_problem, const Runner& runner) {
  const TrialGrouping grouping(plan, new_problem);
  AnswerRows all;
  ReadResults(
      runner.plan(), runner.results(), 0, runner.plan().groups.size(),
      [&](const ItemPlace& place, const std::string& json) { ReadPiece(plan, grouping, place, json, &all); });
  all.SetShares();
  return all;
}

}  // namespace rcme
