#include "experiments/conform/calibration_work.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>

#include "experiments/study/population.h"
#include "experiments/trial/covariance_score.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_range.h"
#include "parameters/input_error.h"
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

// [[refused trials], number without truth, [rows]]
std::string ComputeAnswers(const StudyPlan& plan, const ItemPlace& place) {
  const Condition& condition = plan.conditions[place.group];
  const TrialRange trials = FindTrials(plan, place);
  std::int64_t num_unscored = 0;
  Json refused = Json::array(), rows = Json::array();
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    AnswerRow row;
    const Outcome outcome = MakeRow(plan.study.failure, RunTrialOfDraw(plan, condition, trial), &row);
    num_unscored += outcome == Outcome::kUnscored;
    if (outcome == Outcome::kRefusal) refused.push_back(trial);
    if (outcome == Outcome::kAnswer) rows.push_back(RowAsJson(trial, row));
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
  std::copy(numbers.begin() + 5, numbers.end(), row.features.begin());
  Require((row.is_wrong || numbers[1] == 0.0) && row.nees >= 0.0 && row.max_error_deg >= 0.0 &&
          !std::isnan(row.log_det));
  return row;
}

// The group of a trial: answers of different groups are independent.
class Grouping {
 public:
  Grouping(const StudyPlan& plan, NewProblem new_problem) : plan_(plan), new_problem_(new_problem) {
    if (new_problem == NewProblem::kCondition && plan.study.common_scenes)
      throw InputError(
          "conform: the conditions share their scenes (common_scenes), so none is new; give --new trial");
    for (const Condition& condition : plan.conditions) {
      const std::optional<std::string> scene = condition.source->SharedScene();
      if (scene) scenes_.emplace(*scene, static_cast<std::int64_t>(scenes_.size()));
    }
  }

  std::int64_t Of(const Condition& condition, std::uint32_t trial) const {
    const bool is_new_condition = new_problem_ == NewProblem::kCondition;
    if (const std::optional<std::string> scene = condition.source->SharedScene()) {
      const auto pairs = static_cast<std::uint32_t>(condition.source->NumTrials(1));
      return Pair(scenes_.at(*scene), is_new_condition ? 0 : trial % pairs);
    }
    if (is_new_condition) return Pair(Draw(condition), 0);
    const auto repeats = static_cast<std::uint32_t>(plan_.study.repeats_per_scene);
    return Pair(plan_.study.common_scenes ? 0 : condition.index, trial / repeats);
  }

  std::int64_t NumScenes() const { return std::ssize(scenes_); }

 private:
  static std::int64_t Pair(std::int64_t high, std::uint32_t low) { return (high << 32) + low; }

  // Conditions of one draw differ in the factors alone.
  std::int64_t Draw(const Condition& condition) const {
    const auto factor = std::ranges::find(plan_.factor_names, kDrawFactor);
    if (factor == plan_.factor_names.end()) return condition.index;
    return std::stoll(condition.levels.at(static_cast<size_t>(factor - plan_.factor_names.begin())));
  }

  const StudyPlan& plan_;
  NewProblem new_problem_;
  std::map<std::string, std::int64_t> scenes_;
};

void ReadPiece(const StudyPlan& plan, const Grouping& grouping, const ItemPlace& place,
               const std::string& json, AnswerRows* all) {
  const Condition& condition = plan.conditions[place.group];
  const TrialRange trials = FindTrials(plan, place);
  const std::int64_t most = trials.end - trials.first;
  const Json piece = ParsePiece(json);
  RequireSize(piece, 3);
  Require(piece[0].is_array() && piece[2].is_array() &&
          static_cast<std::int64_t>(piece[0].size() + piece[2].size()) <= most);
  const auto group_of = [&](double trial) {
    Require(trial >= trials.first && trial < trials.end);
    return grouping.Of(condition, static_cast<std::uint32_t>(trial));
  };
  for (const Json& trial : piece[0])
    all->problems.push_back({group_of(static_cast<double>(CountFrom(trial, trials.end))), true});
  all->num_unscored += CountFrom(piece[1], most);
  for (const Json& entry : piece[2]) {
    RequireSize(entry, kNumbersOfRow);
    const std::vector<double> numbers = NumbersFrom(entry);
    AnswerRow& row = all->rows.emplace_back(RowFrom(numbers));
    row.group = group_of(numbers[0]);
    all->problems.push_back({row.group, false});
  }
}

}  // namespace

NewProblem UsualNewProblem(const StudyPlan& plan) {
  const bool is_drawn = plan.study.population.has_value();
  return is_drawn || Grouping(plan, NewProblem::kTrial).NumScenes() > 1 ? NewProblem::kCondition
                                                                        : NewProblem::kTrial;
}

bool HasRealScenes(const StudyPlan& plan) { return Grouping(plan, NewProblem::kTrial).NumScenes() > 0; }

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
  const Grouping grouping(plan, new_problem);
  AnswerRows all;
  ReadResults(
      runner.plan(), runner.results(), 0, runner.plan().groups.size(),
      [&](const ItemPlace& place, const std::string& json) { ReadPiece(plan, grouping, place, json, &all); });
  all.SetShares();
  return all;
}

}  // namespace rcme
