#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/stated_density.h"

namespace rcme {

// The record of one estimator's call in one trial; trial_columns.h describes each number. Unknown numbers
// are NaN: there is no motion, or no truth to compare with.
struct TrialRecord {
  std::uint32_t condition = 0, trial = 0, estimator = 0;
  MotionStatus status = MotionStatus::kInvalidInput;
  double rotation_error_deg = 0.0;  // also known if only the rotation is given
  double direction_error_deg = 0.0;
  double nees = 0.0;  // NaN if the direction is not known
  int num_matches = 0;
  int num_inliers = 0;
  double inlier_precision = 0.0, inlier_recall = 0.0;
  int num_support = 0;
  double mean_entropy = 0.0, z_statistic = 0.0;
  int num_consistent_before = 0, num_consistent_after = 0;
  bool failed_by_kappa = false;
  int num_explained = 0;
  LoopCounts counts;
  double failure_probability = 0.0;
  double sigma_estimated_px = 0.0, sigma_estimated_sd_px = 0.0;
  double inlier_brier = 0.0;
  StatedDensity density;
  int doubt = 0;         // value of the Doubt (motion_estimate.h)
  double seconds = 0.0;  // processor time, plus the time that an estimator outside the program took
};

// The record of the problem of one trial.
struct ProblemRecord {
  std::uint32_t condition = 0, trial = 0;
  double weight = 1.0;
  double num_inliers_true = 0.0;
  Severity severity;
};

// Returns whether the answer is no valid motion or has no valid covariance (answer_check.h). Such an answer
// is a failure, whatever the truth is.
bool IsInvalid(const TrialRecord& record);
// Returns whether the simulator could make the trial.
bool WasSimulated(const TrialRecord& record);
// Returns whether the trial was simulated and its truth is not in doubt. No rate counts other trials, except
// the rate of trials that are not scored.
bool IsCounted(const TrialRecord& record);
// Returns whether no motion was returned: neither a success nor a failure.
bool HasRefused(const TrialRecord& record);
// Returns whether the trial succeeded, failed or was refused. False for a returned motion whose truth is not
// known, and for a trial that does not count (IsCounted).
bool IsScored(const TrialRecord& record);
// Returns whether the answer is invalid, or a returned motion exceeds a bound. False if no motion was
// returned or the truth is not known.
bool HasFailed(const TrialRecord& record, const FailureBounds& bounds);
bool HasFailedOrRefused(const TrialRecord& record, const FailureBounds& bounds);
// Returns whether a motion within the bounds was returned.
bool HasSucceeded(const TrialRecord& record, const FailureBounds& bounds);

// Compares an answer with the truth; no other function does. It checks the answer first (answer_check.h).
TrialRecord Score(const MotionEstimate& estimate, const TrialData& data, double seconds);

struct TrialResult {
  TrialData data;
  ProblemRecord problem;
  std::vector<MotionEstimate> estimates;  // checked; one per estimator of the plan
  std::vector<TrialRecord> records;
  std::string why_not_simulated = {};  // empty: it was simulated
};

// Runs one trial, a pure function of (study, condition, trial): every estimator gets the same problem and
// the same stream of samples. Throws NotSimulated (data_source.h).
TrialResult RunTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// The same, except that a trial of a population's draw which cannot be simulated has records with the status
// kNotSimulated, no data and no estimates.
TrialResult RunTrialOfDraw(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

}  // namespace rcme
