#include "experiments/trial.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>

#include "stats/consistency.h"

namespace rcme {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegPerRad = 180.0 / std::numbers::pi;

void ScoreMotion(const MotionEstimate& estimate, const Truth& truth, TrialRecord* record) {
  if (estimate.status != MotionStatus::kOk || !truth.cam2_from_cam1_true) return;
  const RelativePose& pose_true = *truth.cam2_from_cam1_true;
  record->rotation_error_deg = kDegPerRad * RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R);
  if (!truth.is_direction_known) return;
  record->direction_error_deg = kDegPerRad * AngleBetween(estimate.cam2_from_cam1.t, pose_true.t);
  record->nees =
      NormalizedErrorSquared(LocalCoordinates(estimate.cam2_from_cam1, pose_true), estimate.pose_cov);
}

void ScoreInliers(const MotionEstimate& estimate, const Truth& truth, TrialRecord* record) {
  if (estimate.status != MotionStatus::kOk || truth.is_inlier_true.empty()) return;
  int num_found = 0, num_wrong = 0, num_true = 0;
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    num_found += truth.is_inlier_true[i];
    const bool can_be_told = truth.is_undetectable.empty() || !truth.is_undetectable[i];
    num_wrong += !truth.is_inlier_true[i] && can_be_told;
  }
  for (const bool is_inlier : truth.is_inlier_true) num_true += is_inlier;
  if (num_found + num_wrong > 0) record->inlier_precision = 1.0 * num_found / (num_found + num_wrong);
  if (num_true > 0) record->inlier_recall = 1.0 * num_found / num_true;
}

ProblemRecord Describe(const TrialData& data, const StreamName& name) {
  const std::vector<bool>& is_inlier = data.truth.is_inlier_true;
  const double num_inliers =
      is_inlier.empty() ? kNaN : static_cast<double>(std::count(is_inlier.begin(), is_inlier.end(), true));
  return {name.condition, name.trial, data.weight, num_inliers, data.severity};
}

}  // namespace

bool IsInvalid(const TrialRecord& record) {
  return record.status == MotionStatus::kInvalidMotion || record.status == MotionStatus::kInvalidCovariance;
}

bool HasRefused(const TrialRecord& record) {
  return record.status != MotionStatus::kOk && !IsInvalid(record);
}

bool IsScored(const TrialRecord& record) {
  return record.status != MotionStatus::kOk || !std::isnan(record.rotation_error_deg);
}

bool HasFailed(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return true;
  return record.status == MotionStatus::kOk && (record.rotation_error_deg > bounds.max_rotation_error_deg ||
                                                record.direction_error_deg > bounds.max_direction_error_deg);
}

bool HasSucceeded(const TrialRecord& record, const FailureBounds& bounds) {
  return record.status == MotionStatus::kOk && IsScored(record) && !HasFailed(record, bounds);
}

TrialRecord Score(const MotionEstimate& estimate, const TrialData& data, double seconds) {
  TrialRecord record;
  record.status = estimate.status;
  record.rotation_error_deg = record.direction_error_deg = record.nees = kNaN;
  record.inlier_precision = record.inlier_recall = kNaN;
  record.num_matches = static_cast<int>(data.problem.matches.size());
  record.num_inliers = static_cast<int>(estimate.inliers.size());
  record.num_support = estimate.num_support;
  record.mean_entropy = estimate.num_support > 0 ? estimate.mean_entropy : kNaN;
  record.z_statistic = estimate.num_support > 0 ? estimate.z_statistic : kNaN;
  record.num_consistent_before = estimate.num_consistent_before;
  record.num_consistent_after = estimate.num_consistent_after;
  record.failed_by_kappa = estimate.failed_by_kappa;
  record.num_explained = estimate.num_explained;
  record.counts = estimate.counts;
  record.seconds = seconds;
  ScoreMotion(estimate, data.truth, &record);
  ScoreInliers(estimate, data.truth, &record);
  return record;
}

TrialResult RunTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  const StreamName name{plan.study.seed, condition.index, trial, 0};
  TrialResult result;
  result.data = condition.source->Make(name);
  result.problem = Describe(result.data, name);
  result.estimates.reserve(plan.estimators.size());
  result.records.reserve(plan.estimators.size());
  for (size_t e = 0; e < plan.estimators.size(); ++e) {
    RandomStream sampling_rng = StreamFor(name, StreamPurpose::kSampling);
    const auto start = std::chrono::steady_clock::now();
    result.estimates.push_back(plan.estimators[e]->Estimate(result.data.problem, sampling_rng));
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    TrialRecord record = Score(result.estimates.back(), result.data, elapsed.count());
    record.condition = condition.index;
    record.trial = trial;
    record.estimator = static_cast<std::uint32_t>(e);
    result.records.push_back(record);
  }
  return result;
}

}  // namespace rcme
