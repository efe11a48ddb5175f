// The rare event: a failure, or an error beyond the protection level that the answer itself states.
#pragma once

#include "estimator/motion_estimate.h"
#include "experiments/trial/trial.h"

namespace rcme {

struct RareEvent {
  enum class Kind { kFailure, kMisleadingRotation, kMisleadingDirection };
  Kind kind = Kind::kFailure;
  double risk = 1e-5;  // of the protection levels (estimator/protection_level.h); not used for failures
};
const char* Name(RareEvent::Kind kind);  // "failure", "misleading_rotation", "misleading_direction"

// The greater of rotation and direction error, each divided by its bound: greater than 1 exactly if
// HasFailed. 0 for a refusal, infinite for an answer that is not valid.
double ErrorOverBound(const TrialRecord& record, const FailureBounds& bounds);

// The error of rotation or of direction divided by its protection level: greater than 1 exactly if `rcme
// integrity` counts the answer as misleading. 0 without an answer, or if the error is unknown.
double ErrorOverLevel(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event);

// How near the answer is to the event, which has happened above 1.
double ComputeNearness(const MotionEstimate& estimate, const TrialRecord& record, const RareEvent& event,
                       const FailureBounds& bounds);

}  // namespace rcme
