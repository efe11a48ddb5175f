// The protection levels of an answer at an integrity risk q: the smallest angle that its error of rotation,
// or of direction, exceeds with probability at most q, by what the answer itself states.
//
// An answer states that with probability 1 - P its errors are normal with the covariance `pose_cov`, and that
// with probability P, the failure probability, it is a wrong motion: its error may then be anything. So
//   P(error > r) <= P + (1 - P) P(|e| > r),  e normal with the 3x3 block of the rotation (2x2: direction),
// as the rotation angle is |w| for the rotation vector w and the angle of directions is |b| for the tangent
// coordinates b (geometry/pose.h). The level is
//   pi                                     q <= P: nothing is protected
//   the r with P(|e| > r) = (q - P) / (1 - P), at most pi                               otherwise
// with the exact law of |e| (stats/gaussian_norm.h, its accuracy also). An estimator that states no P (NaN)
// claims P = 0. Angles are at most pi: a rotation vector beyond pi is a smaller angle, so that for
// covariances that wide the level is an upper bound. `other_modes` are part of P and not looked at.
//
// Either level is for its own error: both errors are within with probability at least 1 - 2 q.
#pragma once

#include "estimator/motion_estimate.h"

namespace rcme {

struct ProtectionLevels {
  double rotation_rad = 0.0, direction_rad = 0.0;  // [0, pi]
};

// `risk` in [1e-12, 1). Throws std::invalid_argument that names what is wrong: another risk, a status other
// than kOk, a covariance that is not finite, symmetric and positive semidefinite, a failure probability
// outside of [0, 1].
ProtectionLevels ComputeProtectionLevels(const MotionEstimate& estimate, double risk);

}  // namespace rcme
