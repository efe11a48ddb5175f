#pragma once

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "stats/random.h"

namespace rcme {

// The interface of every estimator.
//
// Estimate is a pure function of (problem, the stream's name). It reads no clock and no global state, and
// several threads may call it at once. It does not throw for bad matches: failures come back as a status and
// a message. It never sees the truth.
class MotionEstimator {
 public:
  virtual ~MotionEstimator() = default;
  virtual MotionEstimate Estimate(const MotionProblem& problem, RandomStream& rng) const = 0;
};

}  // namespace rcme
