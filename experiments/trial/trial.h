#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/study_plan.h"

namespace rcme {

// What is kept of one estimator's call in one trial. Unknown numbers are NaN: no motion, or no truth to
// compare with.
struct TrialRecord {
  std::uint32_t condition = 0, trial = 0, estimator = 0;
  MotionStatus status = MotionStatus::kInvalidInput;
  double rotation_error_deg = 0.0;  // also where the rotation alone is given
  double direction_error_deg = 0.0;
  double nees = 0.0;  // 5 degrees of freedom; NaN: the direction is not known; infinite: nothing is covered
  int num_matches = 0;
  int num_inliers = 0;            // final inliers
  double inlier_precision = 0.0;  // true ones among the final inliers, wrong ones that no test can tell aside
  double inlier_recall = 0.0;     // final inliers among the true ones
  int num_support = 0;            // n_j of the winner
  double mean_entropy = 0.0;      // psi_j of the winner
  double z_statistic = 0.0;
  int num_consistent_before = 0, num_consistent_after = 0;  // n_I, n*_I
  bool failed_by_kappa = false;
  int num_explained = 0;  // of all matches, by the refined motion
  LoopCounts counts;
  double failure_probability = 0.0;  // as the estimator states it; NaN: it states none
  double sigma_estimated_px = 0.0, sigma_estimated_sd_px = 0.0;
  double inlier_brier =
      0.0;        // mean squared error of the inlier probabilities, over the matches that can be classified
  int doubt = 0;  // number of the Doubt (motion_estimate.h)
  // Processor time of the call, of its thread, and the time that an estimator outside the program took; the
  // only field that is not a function of the trial's name.
  double seconds = 0.0;
};

// What is kept of the problem of one trial.
struct ProblemRecord {
  std::uint32_t condition = 0, trial = 0;
  double weight = 1.0;
  double num_inliers_true = 0.0;  // NaN: unknown
  Severity severity;
};

// An answer that is no motion or comes with no covariance (answer_check.h): a failure, whatever the truth is.
bool IsInvalid(const TrialRecord& record);
// No motion: neither a success nor a failure.
bool HasRefused(const TrialRecord& record);
// False for a returned motion whose truth is not known: it has neither failed nor succeeded.
bool IsScored(const TrialRecord& record);
// An invalid answer, or a returned motion beyond a bound. False where no motion was returned, or no truth is
// known.
bool HasFailed(const TrialRecord& record, const FailureBounds& bounds);
bool HasFailedOrRefused(const TrialRecord& record, const FailureBounds& bounds);
// A returned motion within the bounds.
bool HasSucceeded(const TrialRecord& record, const FailureBounds& bounds);

// The only place where truth meets estimate. The answer is judged first (answer_check.h).
TrialRecord Score(const MotionEstimate& estimate, const TrialData& data, double seconds);

struct TrialResult {
  TrialData data;
  ProblemRecord problem;
  std::vector<MotionEstimate> estimates;  // one per estimator of the plan, judged
  std::vector<TrialRecord> records;
};

// One trial, a pure function of (study, condition, trial): every estimator on the same problem, with the same
// stream of samples.
TrialResult RunTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

}  // namespace rcme
