// Errors of the calibration that nobody stated: how probable they are given the matches, and what they add to
// the covariance of the answer.
//
// A priori the calibration is right with probability 1 - pi, and with pi it has errors of usual size, theta ~
// N(0, I) (intrinsics_check.h). By Laplace's approximation, which is exact to the order of the check, the
// matches are more probable under errors than without them by the factor
//
//   B = exp(q'Vq / 2) sqrt(det V),   V = (I_theta + I)^-1,
//
// so that the probability of errors is w = pi B / (1 - pi + pi B). Given errors, the motion is
// N(p - M V q, C + M V M'), C the covariance without errors. About the answer p it has the second moment
// C + A, where A = M (V + V q q' V) M'.
//
// C and A are bounded by a uniform motion (BoundByUniformMotion) once they are added.
//
// Residuals that seem to show errors may also be noise that is not independent, which the covariance then
// counts twice. Dividing q and I_theta by the factor by which the check widens the covariance was tried: as
// the errors raise this factor themselves, it covers less where the calibration is wrong, and costs as much
// where it is right.
#pragma once

#include "estimator/calibrated/intrinsics_check.h"

namespace rcme {

struct UnstatedErrors {
  double probability = 0.0;            // w
  Matrix5d moment = Matrix5d::Zero();  // A, 5x5 [rotation, direction], rad^2

  // C + A, bounded; `covariance`: C before it is bounded.
  Matrix5d AddTo(const Matrix5d& covariance) const;
  // The second moment if there may be errors or not: 1 - w parts of C, bounded, and w of AddTo(C).
  Matrix5d MixInto(const Matrix5d& covariance) const;
};

// `prior_probability`: pi. No errors if the evidence is not finite.
UnstatedErrors WeighUnstatedErrors(const IntrinsicsEvidence& evidence, double prior_probability);

}  // namespace rcme
