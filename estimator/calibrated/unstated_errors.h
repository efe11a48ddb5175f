// Errors of the calibration that nobody stated: how probable they are given the matches, and what they add to
// the covariance of the answer.
//
// A priori the calibration is right with probability 1 - pi, and with pi it has errors of usual size, theta ~
// N(0, D) (intrinsics_check.h), D = I. By Laplace's approximation, which is exact to the order of the check,
// the matches are more probable under errors than without them by the factor
//
//   B = exp(q'Vq / 2) sqrt(det V D^-1),   V = (I_theta + D^-1)^-1,
//
// so that the probability of errors is w = pi B / (1 - pi + pi B). Given errors, the motion is
// N(p - M V q, C + M V M'), C the covariance without errors. About the answer p it has the second moment
// C + A, where A = M (V + V q q' V) M'.
//
// Errors of a kind that is stated are there in any case, with the stated variance in D: B is then divided by
// what it is with the stated kinds alone, and A is that of the other kinds. C counts the stated ones.
//
// C and A are bounded by a uniform motion (BoundByUniformMotion) once they are added.
//
// Residuals that seem to show errors may also be noise that is not independent, which the covariance then
// counts twice. Dividing q and I_theta by the factor by which the check widens the covariance was tried: as
// the errors raise this factor themselves, it covers less where the calibration is wrong, and costs as much
// where it is right.
#pragma once

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/intrinsics_check.h"
#include "estimator/motion_prior.h"

namespace rcme {

struct UnstatedErrors {
  double probability = 0.0;  // w
  // Given errors: how far the mean of the motion is from the answer, and what they add to C. [rotation,
  // direction], rad and rad^2.
  Vector5d shift = Vector5d::Zero();
  Matrix5d spread = Matrix5d::Zero();

  Matrix5d Moment() const { return spread + shift * shift.transpose(); }  // A

  // C + A, bounded; `covariance`: C before it is bounded.
  Matrix5d AddTo(const Matrix5d& covariance) const;
  // The second moment if there may be errors or not: 1 - w parts of C, bounded, and w of AddTo(C).
  Matrix5d MixInto(const Matrix5d& covariance) const;
};

// `prior_probability`: pi. No errors if the evidence is not finite.
UnstatedErrors WeighUnstatedErrors(const IntrinsicsEvidence& evidence, double prior_probability);

// The errors that the options count at a mode of the matches, with the kinds that they state.
UnstatedErrors FindUnstatedErrors(const MotionProblem& problem, const Mode& mode,
                                  const Explanation& explanation, const CalibratedOptions& options);

// The errors of an answer x from matches and a prior of the motion. `errors` are those of the matches, whose
// optimum without the prior is x - d, with the covariance C = covariance_of_matches. A prior far from this
// optimum is improbable without errors: w is updated by the ratio of the densities of the prior's residuals
// under both laws of the motion,
//
//   N(x - d, C)  and  N(x - d + shift, C + spread),
//
// and the errors returned are what the second law, given the prior, adds to the first about x (Kalman's
// update of each).
UnstatedErrors UpdateByPrior(const UnstatedErrors& errors, const Matrix5d& covariance_of_matches,
                             const PriorResiduals& at_answer);

}  // namespace rcme
