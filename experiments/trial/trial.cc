#include "experiments/trial/trial.h"

#include <algorithm>
#include <cmath>

#include "experiments/core/work/thread_time.h"
#include "experiments/trial/answer_check.h"
#include "experiments/trial/simulate_draw.h"
#include "stats/consistency.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Returns whether the status comes with a valid motion, or at least a valid rotation.
bool HasMotion(MotionStatus status) {
  return status == MotionStatus::kOk || status == MotionStatus::kInvalidCovariance;
}
bool HasRotation(MotionStatus status) {
  return HasMotion(status) || status == MotionStatus::kDirectionNotObservable;
}

// An invalid answer covers nothing. The errors of truth and estimate are independent, so their covariances
// add.
double ComputeNees(const MotionEstimate& estimate, const Truth& truth) {
  if (estimate.status != MotionStatus::kOk) return kInfinity;
  const RelativePose& pose = estimate.cam2_from_cam1;
  Matrix5d covariance = estimate.pose_cov;
  if (truth.sd) covariance += truth.sd->CovarianceAt(pose);
  const double nees = NormalizedErrorSquared(LocalCoordinates(pose, *truth.cam2_from_cam1_true), covariance);
  return std::isnan(nees) ? kInfinity : nees;  // overflow: Sigma is practically zero
}

void ScoreMotion(const MotionEstimate& estimate, const Truth& truth, TrialRecord* record) {
  if (!truth.cam2_from_cam1_true) return;
  const RelativePose& pose_true = *truth.cam2_from_cam1_true;
  if (HasRotation(estimate.status)) {
    record->rotation_error_deg = kDegPerRad * RotationAngleBetween(estimate.cam2_from_cam1.R, pose_true.R);
  }
  if (!truth.is_direction_known) return;
  if (HasMotion(estimate.status))
    record->direction_error_deg = kDegPerRad * AngleBetween(estimate.cam2_from_cam1.t, pose_true.t);
  if (IsCounted(*record) && !HasRefused(*record)) record->nees = ComputeNees(estimate, truth);
}

void ScoreInliers(const MotionEstimate& estimate, const Truth& truth, TrialRecord* record) {
  if (estimate.status != MotionStatus::kOk || truth.is_inlier_true.empty()) return;
  int num_found = 0, num_wrong = 0, num_true = 0;
  for (const int index : estimate.inliers) {
    const auto i = static_cast<size_t>(index);
    num_found += truth.is_inlier_true[i];
    const bool can_be_classified = truth.is_undetectable.empty() || !truth.is_undetectable[i];
    num_wrong += !truth.is_inlier_true[i] && can_be_classified;
  }
  for (const bool is_inlier : truth.is_inlier_true) num_true += is_inlier;
  if (num_found + num_wrong > 0) record->inlier_precision = 1.0 * num_found / (num_found + num_wrong);
  if (num_true > 0) record->inlier_recall = 1.0 * num_found / num_true;
}

// NaN if there are no probabilities or no true labels.
double BrierOfInliers(const MotionEstimate& estimate, const Truth& truth) {
  const size_t n = estimate.inlier_probabilities.size();
  if (n == 0 || truth.is_inlier_true.size() != n) return kNaN;
  double sum = 0.0;
  int count = 0;
  for (size_t i = 0; i < n; ++i) {
    if (!truth.is_undetectable.empty() && truth.is_undetectable[i]) continue;
    const double error = estimate.inlier_probabilities[i] - (truth.is_inlier_true[i] ? 1.0 : 0.0);
    sum += error * error;
    ++count;
  }
  return count == 0 ? kNaN : sum / count;
}

ProblemRecord Describe(const TrialData& data, const Condition& condition, std::uint32_t trial) {
  const std::vector<bool>& is_inlier = data.truth.is_inlier_true;
  const double num_inliers =
      is_inlier.empty() ? kNaN : static_cast<double>(std::count(is_inlier.begin(), is_inlier.end(), true));
  return {condition.index, trial, data.weight, num_inliers, data.severity};
}

TrialRecord ScoreJudged(const MotionEstimate& judged, const TrialData& data, double seconds) {
  TrialRecord record;
  record.status = judged.status;
  record.rotation_error_deg = record.direction_error_deg = record.nees = kNaN;
  record.inlier_precision = record.inlier_recall = kNaN;
  record.num_matches = static_cast<int>(data.problem.matches.size());
  record.num_inliers = static_cast<int>(judged.inliers.size());
  record.num_support = judged.num_support;
  record.mean_entropy = judged.num_support > 0 ? judged.mean_entropy : kNaN;
  record.z_statistic = judged.num_support > 0 ? judged.z_statistic : kNaN;
  record.num_consistent_before = judged.num_consistent_before;
  record.num_consistent_after = judged.num_consistent_after;
  record.failed_by_kappa = judged.failed_by_kappa;
  record.num_explained = judged.num_explained;
  record.counts = judged.counts;
  record.failure_probability = judged.failure_probability;
  record.sigma_estimated_px = judged.sigma_estimated_px;
  record.sigma_estimated_sd_px = judged.sigma_estimated_sd_px;
  record.inlier_brier = BrierOfInliers(judged, data.truth);
  record.doubt = static_cast<int>(judged.doubt);
  record.seconds = seconds;
  if (data.truth.is_in_doubt && WasSimulated(record)) {
    record.status = MotionStatus::kTruthInDoubt;
    return record;
  }
  ScoreMotion(judged, data.truth, &record);
  record.density = DescribeStatedDensity(judged, data.truth, data.severity, record.nees);
  ScoreInliers(judged, data.truth, &record);
  return record;
}

}  // namespace

bool IsInvalid(const TrialRecord& record) {
  return record.status == MotionStatus::kInvalidMotion || record.status == MotionStatus::kInvalidCovariance;
}

bool WasSimulated(const TrialRecord& record) { return record.status != MotionStatus::kNotSimulated; }

bool IsCounted(const TrialRecord& record) {
  return WasSimulated(record) && record.status != MotionStatus::kTruthInDoubt;
}

bool HasRefused(const TrialRecord& record) {
  return record.status != MotionStatus::kOk && !IsInvalid(record) && IsCounted(record);
}

bool IsScored(const TrialRecord& record) {
  if (!IsCounted(record)) return false;
  return record.status != MotionStatus::kOk || !std::isnan(record.rotation_error_deg);
}

bool HasFailed(const TrialRecord& record, const FailureBounds& bounds) {
  if (IsInvalid(record)) return true;
  return record.status == MotionStatus::kOk && (record.rotation_error_deg > bounds.max_rotation_error_deg ||
                                                record.direction_error_deg > bounds.max_direction_error_deg);
}

bool HasFailedOrRefused(const TrialRecord& record, const FailureBounds& bounds) {
  return HasRefused(record) || HasFailed(record, bounds);
}

bool HasSucceeded(const TrialRecord& record, const FailureBounds& bounds) {
  return record.status == MotionStatus::kOk && IsScored(record) && !HasFailed(record, bounds);
}

TrialRecord Score(const MotionEstimate& estimate, const TrialData& data, double seconds) {
  return ScoreJudged(Judged(estimate, data.problem.matches.size()), data, seconds);
}

TrialResult RunTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  const StreamName name = NameOfTrial(plan, condition, trial);
  TrialResult result;
  result.data = condition.source->Make(NameOfScene(plan, condition, trial));
  result.problem = Describe(result.data, condition, trial);
  const auto& estimators = FindEstimators(plan, condition);
  result.estimates.resize(estimators.size());
  result.records.resize(estimators.size());
  for (size_t turn = 0; turn < estimators.size(); ++turn) {
    // The first estimator finds the problem in no cache, so the estimators take turns at being first.
    const size_t e = (turn + trial) % estimators.size();
    RandomStream sampling_rng = StreamFor(name, StreamPurpose::kSampling);
    const double start = ThreadSeconds();
    MotionEstimate estimate = estimators[e]->Estimate(result.data.problem, sampling_rng);
    double seconds = ThreadSeconds() - start;
    if (estimate.seconds_elsewhere >= 0.0) seconds += estimate.seconds_elsewhere;
    result.estimates[e] = Judged(std::move(estimate), result.data.problem.matches.size());
    TrialRecord record = ScoreJudged(result.estimates[e], result.data, seconds);
    record.condition = condition.index;
    record.trial = trial;
    record.estimator = static_cast<std::uint32_t>(e);
    result.records[e] = record;
  }
  return result;
}

TrialResult RunTrialOfDraw(const StudyPlan& plan, const Condition& condition, std::uint32_t trial) {
  SimulatedDraw<TrialResult> simulated =
      SimulateDraw(plan.study, [&] { return RunTrial(plan, condition, trial); });
  if (simulated.made) return *std::move(simulated.made);
  TrialResult result;
  result.why_not_simulated = std::move(simulated.why_not);
  result.problem = Describe(result.data, condition, trial);
  MotionEstimate nothing;
  nothing.status = MotionStatus::kNotSimulated;
  TrialRecord record = ScoreJudged(nothing, result.data, 0.0);
  record.condition = condition.index;
  record.trial = trial;
  for (; record.estimator < FindEstimators(plan, condition).size(); ++record.estimator)
    result.records.push_back(record);
  return result;
}

}  // namespace rcme
