#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

// The contract of every estimator, the one virtual call of a trial.
//
// Estimate is a pure function of (problem, the stream's name): no clock, no global state, callable from
// several threads at once. It never throws for bad matches: whatever is wrong comes back as a status and a
// sentence. The truth never reaches it.
class MotionEstimator {
 public:
  virtual ~MotionEstimator() = default;
  virtual MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const = 0;
};

}  // namespace rcme
