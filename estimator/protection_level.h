// Protection levels of an answer at an integrity risk q: the smallest angle that the error of the rotation,
// or of the direction, exceeds with probability at most q, according to the answer itself.
//
// An answer states that with probability 1 - P its errors are normal with covariance `pose_cov`, or, if the
// calibration may have errors that nobody stated, a mixture of two normal laws: with the covariance
// `pose_cov_with_errors` and `calibration_error_probability` as its weight, and without them. With
// probability P, the failure probability, it is a wrong motion with an arbitrary error. So
//   P(error > r) <= P + (1 - P) P(|e| > r),  e normal with the 3x3 block of the rotation (2x2: direction),
// (the tails of a mixture add up), where |e| is the error angle: |w| of the rotation vector w, |b| of the
// tangent coordinates b of the direction (geometry/pose.h). The level is
//   pi                                     if q <= P: nothing is protected
//   the r with P(|e| > r) = (q - P) / (1 - P), at most pi                               otherwise
// with the exact law of |e| (stats/gaussian_norm.h, which states its accuracy). An estimator that states no P
// (NaN) claims P = 0. Angles are at most pi: a rotation vector longer than pi is a smaller angle, so for very
// wide covariances the level is an upper bound. `other_modes` are part of P and not used.
//
// Each level holds for its own error; both errors are within their levels with probability at least 1 - 2 q.
#pragma once

#include "estimator/motion_estimate.h"

namespace rcme {

struct ProtectionLevels {
  double rotation_rad = 0.0, direction_rad = 0.0;  // [0, pi]
};

// `risk` in [1e-12, 1). Throws std::invalid_argument with the reason for a risk outside of this range, a
// status other than kOk, a covariance that is not finite, symmetric and positive semidefinite, or a failure
// probability outside of [0, 1].
ProtectionLevels ComputeProtectionLevels(const MotionEstimate& estimate, double risk);

}  // namespace rcme
