#pragma once

#include "estimator/motion_estimator.h"
#include "experiments/claims/case.h"
#include "experiments/trial/trial.h"

namespace rcme {

// One call of an estimator on the case and its score against the truth; every estimator gets the same stream
// of samples.
TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made);

// What an answer says of the covariance it comes with:
//   0  NEES of the motion. Infinite, and so not covered, for an answer that is not valid or whose NEES is not
//      finite. NaN, and so not counted, for a refusal and for a motion beyond the failure bounds: how often a
//      wrong motion is returned is a question of its own, answered by statistic 2.
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

// What an answer says of its stated probability of failure P, y being 1 where it failed:
//   0  P - y;  1  (P - y) P, which many confident mistakes or too much caution move;  2  y where P is at most
//   0.1 3  (P - y)^2;  4  P.
// NaN where no P is stated, and for a refusal.
Outcome StatedProbabilityStatistic(const TrialRecord& record, const FailureBounds& bounds = FailureBounds());
// The targets for it: the first three are claimed.
std::vector<Target> StatedProbabilityTargets();

// Whether the call failed where a refusal ("Detect-fail") counts as no failure, and where it counts as one.
bool FailsSilently(const TrialRecord& record);
bool FailsOrRefuses(const TrialRecord& record);

// For a comparison in pairs: among the trials in which exactly one of two had the event, 1 if it was the
// first; NaN in the others.
double OnlyFirst(bool first, bool second);

}  // namespace rcme
