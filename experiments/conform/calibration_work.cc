#include "experiments/conform/calibration_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/core/text/program_name.h"
#include "experiments/trial/covariance_score.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"
#include "stats/constants.h"

namespace rcme {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint32_t kTrialsOfItem = 50;
constexpr size_t kNumbersOfRow = 5 + kNumVisibleFeatures;

TrialRange FindTrials(const StudyPlan& plan, const ItemPlace& place) {
  const auto first = static_cast<std::uint32_t>(place.item) * kTrialsOfItem;
  const auto end = static_cast<std::uint32_t>(plan.conditions[place.group].num_trials);
  return {first, std::min(first + kTrialsOfItem, end)};
}

double LogDeterminant(const Matrix5d& covariance) {
  const Eigen::LDLT<Matrix5d> ldlt(covariance);
  return ldlt.vectorD().array().max(0.0).log().sum();
}

// Nothing where the trial has no answer, or nobody knows how wrong it is.
enum class Outcome { kAnswer, kRefusal, kUnscored };
Outcome MakeRow(const FailureBounds& bounds, const TrialResult& result, AnswerRow* row) {
  const TrialRecord& record = result.records.front();
  if (!WasSimulated(record)) return Outcome::kUnscored;
  if (HasRefused(record)) return Outcome::kRefusal;
  const MotionEstimate& estimate = result.estimates.front();
  row->features = MeasureVisibleFeatures(result.data.problem, estimate);
  row->is_wrong = HasFailed(record, bounds);
  row->nees = row->max_error_deg = row->log_det = kInfinity;
  if (IsInvalid(record)) return Outcome::kAnswer;
  if (!result.data.truth.cam2_from_cam1_true || !result.data.truth.is_direction_known)
    return Outcome::kUnscored;
  const double nees = NormalizedErrorOfPose(estimate.cam2_from_cam1, estimate.pose_cov,
                                            *result.data.truth.cam2_from_cam1_true);
  row->nees = std::isnan(nees) ? kInfinity : nees;
  row->max_error_deg = std::max(record.rotation_error_deg, record.direction_error_deg);
  row->log_det = LogDeterminant(estimate.pose_cov);
  return Outcome::kAnswer;
}

// [trial, wrong, nees, error, log det, features ...]
Json RowAsJson(std::uint32_t trial, const AnswerRow& row) {
  std::vector<double> numbers = {static_cast<double>(trial), row.is_wrong ? 1.0 : 0.0, row.nees,
                                 row.max_error_deg, row.log_det};
  numbers.insert(numbers.end(), row.features.begin(), row.features.end());
  return NumbersAsJson(numbers);
}

std::string ComputeAnswers(const StudyPlan& plan, const ItemPlace& place) {
  const Condition& condition = plan.conditions[place.group];
  const TrialRange trials = FindTrials(plan, place);
  std::int64_t num_refusals = 0, num_unscored = 0;
  Json rows = Json::array();
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    AnswerRow row;
    const Outcome outcome = MakeRow(plan.study.failure, RunTrialOfDraw(plan, condition, trial), &row);
    num_refusals += outcome == Outcome::kRefusal;
    num_unscored += outcome == Outcome::kUnscored;
    if (outcome == Outcome::kAnswer) rows.push_back(RowAsJson(trial, row));
  }
  return Json{num_refusals, num_unscored, std::move(rows)}.dump();
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
  std::copy(numbers.begin() + 5, numbers.end(), row.features.begin());
  Require((row.is_wrong || numbers[1] == 0.0) && row.nees >= 0.0 && row.max_error_deg >= 0.0 &&
          !std::isnan(row.log_det));
  return row;
}

}  // namespace

NewProblem UsualNewProblem(const StudyPlan& plan) {
  const bool is_drawn = plan.study.population.has_value();
  const bool is_real =
      plan.conditions.size() > 1 && std::ranges::all_of(plan.conditions, [](const Condition& condition) {
        return condition.source->SharedScene().has_value();
      });
  return is_drawn || is_real ? NewProblem::kCondition : NewProblem::kTrial;
}

WorkPlan PlanCalibration(const StudyPlan& plan) {
  WorkPlan work{"conform", "block", plan.identity, {}};
  for (const Condition& condition : plan.conditions) {
    const auto num_trials = static_cast<size_t>(condition.num_trials);
    work.groups.push_back(
        {fmt::format("condition {}", condition.index), (num_trials + kTrialsOfItem - 1) / kTrialsOfItem});
  }
  return work;
}

void GetCalibration(const StudyPlan& plan, Runner* runner) {
  const ProgressUnit unit{"trials", [&](const ItemPlace& place) -> std::int64_t {
                            const TrialRange trials = FindTrials(plan, place);
                            return trials.end - trials.first;
                          }};
  runner->Get(
      ListItems(runner->plan(), runner->shard()),
      [&](const ItemPlace& place) { return ComputeAnswers(plan, place); }, unit);
}

AnswerRows ReadCalibration(const StudyPlan& plan, NewProblem new_problem, const Runner& runner) {
  AnswerRows all;
  ReadResults(runner.plan(), runner.results(), 0, runner.plan().groups.size(),
              [&](const ItemPlace& place, const std::string& json) {
                const TrialRange trials = FindTrials(plan, place);
                const std::int64_t most = trials.end - trials.first;
                const Json piece = ParsePiece(json);
                RequireSize(piece, 3);
                all.num_refusals += CountFrom(piece[0], most);
                all.num_unscored += CountFrom(piece[1], most);
                Require(piece[2].is_array() && static_cast<std::int64_t>(piece[2].size()) <= most);
                for (const Json& entry : piece[2]) {
                  RequireSize(entry, kNumbersOfRow);
                  const std::vector<double> numbers = NumbersFrom(entry);
                  Require(numbers[0] >= trials.first && numbers[0] < trials.end);
                  AnswerRow& row = all.rows.emplace_back(RowFrom(numbers));
                  const auto scene = static_cast<std::int64_t>(numbers[0]) / plan.study.repeats_per_scene;
                  row.group = new_problem == NewProblem::kCondition
                                  ? static_cast<std::int64_t>(place.group)
                                  : (static_cast<std::int64_t>(place.group) << 32) + scene;
                }
              });
  return all;
}

}  // namespace rcme
