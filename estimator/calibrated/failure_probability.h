// Step 7 of rcme_calibrated: the probability that the motion is further from the truth than the bounds.
#pragma once

#include "estimator/geometry/pose.h"
#include "stats/random.h"

namespace rcme {

struct MotionBounds {
  double rotation_rad, direction_rad;
};

// The probability that a motion, distributed as N(mean, covariance) in the tangent at `mean`, lies within the
// bounds around `answer`. Uses 64 antithetic pairs of draws of `rng`. If the bounds are more than six
// standard deviations away, returns 1 or 0 without a draw.
double MassWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& mean,
                  const Matrix5d& covariance, RandomStream& rng);

bool IsWithin(const RelativePose& answer, const MotionBounds& bounds, const RelativePose& pose);

}  // namespace rcme
