#pragma once

#include "estimator/motion_estimator.h"
#include "experiments/claims/case.h"
#include "experiments/trial.h"

namespace rcme {

// One call of an estimator on the case and its score against the truth; every estimator gets the same stream
// of samples.
TrialRecord CallEstimator(const MotionEstimator& estimator, const Case& made);

// What a call says of the covariance it returns: NEES of the motion (NaN if none is returned,
// infinite if what is returned is not valid), whether one is returned, whether it failed by the bounds.
Outcome ReportedCovarianceStatistic(const MotionEstimator& estimator, const Case& made,
                                    const FailureBounds& bounds = FailureBounds());

// Whether the call failed where a refusal ("Detect-fail") counts as no failure, and where it counts as one.
bool FailsSilently(const TrialRecord& record);
bool FailsOrRefuses(const TrialRecord& record);

// For a comparison in pairs: among the trials in which exactly one of two had the event, 1 if it was the
// first; NaN in the others.
double OnlyFirst(bool first, bool second);

}  // namespace rcme
