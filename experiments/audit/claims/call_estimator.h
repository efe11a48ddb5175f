#pragma once

#include "estimator/motion_estimator.h"
#include "experiments/audit/claims/case.h"
#include "experiments/trial/trial.h"

namespace rcme {

// The score of an estimator's answer on a case. Every estimator gets the same stream of samples.
TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made);

// Statistics of an answer's covariance:
//   0  NEES of the motion. Infinite, hence not covered, for an answer that is not valid or whose NEES is not
//      finite. NaN, hence not counted, for a refusal and for a motion beyond the failure bounds; another
//      claim checks how often these occur (StatedFailureTargets).
//   1  whether a motion is returned, valid or not
//   2  whether it fails: not valid, or beyond the bounds
//   3  whether it is not valid
//   4  difficulty of the problem: root of the trace of its Cramer-Rao bound, deg; NaN if it has none
Outcome CovarianceStatistic(const TrialRecord& record, const Case& made,
                            const FailureBounds& bounds = FailureBounds());
Outcome ReportedCovarianceStatistic(const MotionEstimator& estimator, const Case& made,
                                    const FailureBounds& bounds = FailureBounds());
inline constexpr size_t kDifficultyStatistic = 4;
// Their targets: coverage and mean PIT of statistic 0 are claimed, the rates are measured.
std::vector<Target> ReportedCovarianceTargets();

// The probability, according to its covariance, that an answer (status ok) is beyond the bounds: the share of
// 16 motions drawn from the covariance around the answer that are. If the truth is distributed around the
// answer as the covariance says, the mean of this share is the rate of failures, for any size of covariance
// and bounds.
double DrawShareBeyond(const MotionEstimate& answer, const FailureBounds& bounds, RandomStream& rng);

// The failure that the covariance of an answer implies, for an answer without a stated probability of
// failure.
struct ImpliedFailure {
  double share = 0.0;  // DrawShareBeyond
  // None of another set of drawn motions is beyond. This selection does not bias the mean of `share`.
  bool is_sure = true;
};

// Statistics of an answer's failure. y is 1 if it failed, P its stated probability of failure:
//   0  y minus the probability of failure, P or the implied one, if the answer is sure: P is at most 0.01, or
//      the implied one is_sure
//   1  P - y
//   2  (P - y) P, which shows many confident mistakes or too much caution
//   3  y if P is at most 0.1
//   4  (P - y)^2
//   5  P
// NaN for a refusal; without a stated P, NaN for all but the first.
Outcome FailureStatistic(const TrialRecord& record, const ImpliedFailure& implied,
                         const FailureBounds& bounds = FailureBounds());
Outcome StatedFailureStatistic(const MotionEstimator& estimator, Case& made,
                               const FailureBounds& bounds = FailureBounds());
// Their targets: the first is claimed of every estimator, the next three of one that states P.
std::vector<Target> StatedFailureTargets();

// Statistics of an answer's noise level:
//   0  stated over true sigma, minus 1, at most 1
//   1  the squared error in stated standard deviations
// NaN if none is stated, and for a refusal or an answer that is not valid.
Outcome SigmaStatistic(const TrialRecord& record, double sigma_px_true);
// Their targets, claimed of an estimator that states sigma; the second, if it states its standard deviation.
std::vector<Target> StatedSigmaTargets();

// Whether the call failed. A refusal ("Detect-fail") counts as no failure in the first, as a failure in the
// second.
bool FailsSilently(const TrialRecord& record);
bool FailsOrRefuses(const TrialRecord& record);

// For a paired comparison. In trials in which exactly one of two had the event: 1 if it was the first, else
// 0. NaN in all other trials.
double OnlyFirst(bool first, bool second);

}  // namespace rcme
