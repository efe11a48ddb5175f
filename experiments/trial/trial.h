#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/stated_density.h"

namespace rcme {

// What is kept of one estimator's call in one trial; trial_columns.h says what each number is. Unknown ones
// are NaN: no motion, or no truth to compare with.
struct TrialRecord {
  std::uint32_t condition = 0, trial = 0, estimator = 0;
  MotionStatus status = MotionStatus::kInvalidInput;
  double rotation_error_deg = 0.0;  // also where the rotation alone is given
  double direction_error_deg = 0.0;
  double nees = 0.0;  // NaN: the direction is not known
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
  int doubt = 0;         // number of the Doubt (motion_estimate.h)
  double seconds = 0.0;  // and the time that an estimator outside the program took
};

// What is kept of the problem of one trial.
struct ProblemRecord {
  std::uint32_t condition = 0, trial = 0;
  double weight = 1.0;
  double num_inliers_true = 0.0;
  Severity severity;
};

// An answer that is no motion or comes with no covariance (answer_check.h): a failure, whatever the truth is.
bool IsInvalid(const TrialRecord& record);
// There was a problem to be solved: the simulator could make the trial.
bool WasSimulated(const TrialRecord& record);
// It was simulated, and its truth is not in doubt: the others count in no rate but in that of what is not
// scored.
bool IsCounted(const TrialRecord& record);
// No motion: neither a success nor a failure.
bool HasRefused(const TrialRecord& record);
// False for a returned motion whose truth is not known, and for a trial that was not simulated or whose truth
// is in doubt: none has failed or succeeded.
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
  std::string why_not_simulated = {};  // empty: it was
};

// One trial, a pure function of (study, condition, trial): every estimator on the same problem, with the same
// stream of samples. Throws NotSimulated (data_source.h).
TrialResult RunTrial(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

// The same, where the condition is a draw of a population and the trial cannot be simulated: records that say
// so (kNotSimulated), and no data and no estimates.
TrialResult RunTrialOfDraw(const StudyPlan& plan, const Condition& condition, std::uint32_t trial);

}  // namespace rcme
