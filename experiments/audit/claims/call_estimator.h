#pragma once

#include "estimator/motion_estimator.h"
#include "experiments/audit/claims/case.h"
#include "experiments/trial/trial.h"

namespace rcme {

// One call of an estimator on the case and its score against the truth; every estimator gets the same stream
// of samples.
struct ScoredAnswer {
  MotionEstimate answer;  // as it was given
  TrialRecord record;
};
ScoredAnswer AskEstimator(const MotionEstimator& estimator, const Case& made);
// The score alone.
TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made);

// What an answer says of the covariance it comes with:
//   0  NEES of the motion. Infinite, and so not covered, for an answer that is not valid or whose NEES is not
//      finite. NaN, and so not counted, for a refusal and for a motion beyond the failure bounds: whether
//      more of them are than the answers say is a claim of its own (StatedFailureTargets).
//   1  whether a motion is returned, valid or not
//   2  whether it fails: not valid, or beyond the bounds
//   3  whether it is not valid
//   4  how hard the problem is: root of the trace of its Cramer-Rao bound, deg; NaN: it has none
Outcome CovarianceStatistic(const TrialRecord& record, const Case& made,
                            const FailureBounds& bounds = FailureBounds());
Outcome ReportedCovarianceStatistic(const MotionEstimator& estimator, const Case& made,
                                    const FailureBounds& bounds = FailureBounds());
inline constexpr size_t kDifficultyStatistic = 4;
// The targets for it: coverage and mean PIT of statistic 0 are claimed, the rates are measured.
std::vector<Target> ReportedCovarianceTargets();

// The probability that an answer (status ok) is beyond the bounds as its covariance has it: the share of some
// motions drawn from it around the answer that are. Where the truth is distributed around the answer as the
// covariance says, its mean is the rate of failures, whatever the size of covariance and bounds.
double DrawShareBeyond(const MotionEstimate& answer, const FailureBounds& bounds, RandomStream& rng);

// What an answer without a stated probability of failure says by its covariance.
struct ImpliedFailure {
  double share = 0.0;  // DrawShareBeyond
  bool is_sure =
      true;  // no other motions drawn are beyond: a choice that leaves the mean of `share` as it is
};

// What an answer says of its failures, y being 1 where it failed, and P the stated probability of it:
//   0  y less the probability that the answer says, P or the implied one, if the answer is sure: P is at most
//   0.01, or the implied one is_sure
//   1  P - y;  2  (P - y) P, which many confident mistakes or too much caution move;  3  y where P is at most
//   0.1;  4  (P - y)^2;  5  P.
// NaN where no P is stated but for the first, and for a refusal.
Outcome FailureStatistic(const TrialRecord& record, const ImpliedFailure& implied,
                         const FailureBounds& bounds = FailureBounds());
Outcome StatedFailureStatistic(const MotionEstimator& estimator, Case& made,
                               const FailureBounds& bounds = FailureBounds());
// The targets for it: the first is claimed of every estimator, the next three of one that states P.
std::vector<Target> StatedFailureTargets();

// What an answer says of the noise level:
//   0  stated over true sigma, less 1, at most 1;  1  the squared error in stated standard deviations.
// NaN where none is stated, and for a refusal or an answer that is not valid.
Outcome SigmaStatistic(const TrialRecord& record, double sigma_px_true);
// The targets for it, claimed of an estimator that states sigma, the second where it states its standard
// deviation.
std::vector<Target> StatedSigmaTargets();

// Whether the call failed where a refusal ("Detect-fail") counts as no failure, and where it counts as one.
bool FailsSilently(const TrialRecord& record);
bool FailsOrRefuses(const TrialRecord& record);

// For a comparison in pairs: among the trials in which exactly one of two had the event, 1 if it was the
// first; NaN in the others.
double OnlyFirst(bool first, bool second);

}  // namespace rcme
