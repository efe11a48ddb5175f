// Step 7 of rcme_calibrated: the probability that the motion is further from the truth than the bounds.
#pragma once

#include "estimator/geometry/pose.h"
#include "stats/random.h"

namespace rcme {

struct MotionBounds {
  double rotation_rad, direction_rad;
};

// Of a motion distributed as N(mean, covariance) in the tangent at `mean`: the probability that it lies
// within the bounds around `answer`; by 128 antithetic draws of `rng`, or 1 or 0 without a draw where the
// bounds are beyond six standard deviations.
double MassWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& mean,
                  const Matrix5d& covariance, RandomStream& rng);

bool IsWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& pose);

}  // namespace rcme
