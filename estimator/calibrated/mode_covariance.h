// Step 8 of rcme_calibrated: the covariance of a mode, 5x5 [rotation, direction], rad^2.
#pragma once

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"

namespace rcme {

// H^-1, where H is the Hessian of the likelihood at the optimum by central differences of its gradient, with
// steps of a tenth of a standard deviation. With little parallax, noise seems to determine the direction
// (observability.h). The second derivatives of the residuals, which this Hessian includes, correct this. With
// a prior of the motion, H is the Hessian of the posterior.
Matrix5d InverseOfObserved(const MatchBlocks& matches, const Mode& mode, const MixturePrior& prior = {});

// For each column of `axes` (H^-1 times a unit vector), the number of matches on which the variance along
// this axis rests: (sum c)^2 / sum c^2, where c is the contribution of a match (Kish 1965).
Vector5d EffectiveMatches(const Mode& mode, const Explanation& explanation, const Matrix5d& axes);

// The sandwich H^-1 S H^-1. S is a sum over the matches, with psi = v u:
// - S = sum (p psi / s)^2 / (1 - h) J'J. Each residual gives its own variance. If all errors have the same, a
//   residual with leverage h has the variance 1 - h of its error (HC2, MacKinnon and White 1985). The greater
//   (1 - h)^2 of HC3 makes standard deviations of ten to thirty matches 1.4 times as great.
// - Along a direction in which the mean variance of all residuals gives a greater S, S is that one: a few
//   matches that decide a direction estimate their own variance poorly.
// - A match is an outlier with probability w / 2 (influence.h; w is about twice too great). It would have
//   moved the motion by H^-1 J' p psi / ((1 - h) s), and without it its information is missing. By the law of
//   total variance S grows by w / 2 ((p psi)^2 / (1 - h)^2 + p v / (1 - h)) / s^2 J'J. The factor 1 - w / 2
//   of the first term is left out.
// - The variance along each principal axis is multiplied by k / (k - 2), because the variance is estimated. k
//   is the effective number of matches of the axis if that is below thirty, else the degrees of freedom.
//
// Returns the mode's inverse information if the result is not finite. With a prior of the motion this is the
// part of the covariance that the noise of the matches causes; PriorCovariance is the other part.
Matrix5d SandwichCovariance(const Mode& mode, const Explanation& explanation,
                            const Matrix5d& inverse_of_observed);

// The part of the covariance that the noise of the prior's measurements causes. As r is N(0, I), their score
// J' r (motion_prior.h) has the variance J' J and moves the motion by H^-1 J' r, so that this part is H^-1 J'
// J H^-1. Zero without a prior.
Matrix5d PriorCovariance(const Mode& mode, const MixturePrior& prior, const Matrix5d& inverse_of_observed);

// Converts a covariance C of the optimum of the matches alone, of any kind, into that of the optimum with the
// prior: H^-1 (M C M + J' J) H^-1, where M is the information of the matches. Unchanged without a prior.
Matrix5d CovarianceWithPrior(const Matrix5d& covariance_of_matches, const Mode& mode,
                             const MixturePrior& prior);

// The covariance that uncertain intrinsics add (uncertainty/calibration_prior.h), by the mixture's
// likelihood.
Matrix5d IntrinsicsCovariance(const MotionProblem& problem, const CalibrationPrior& calibration,
                              const Mode& mode, const Matrix5d& inverse_of_observed);

// Adds the information that every motion has, because rotations and directions are bounded: that of a uniform
// law of both, whose variance is pi^2 / 9 + 2/3 about each axis of rotation and (pi^2 - 4) / 4 along each
// coordinate of the direction (standard deviations of 76 and 69 deg). Without it the covariance of a motion
// that its matches do not determine has no bound.
Matrix5d BoundByUniformMotion(Matrix5d covariance);

}  // namespace rcme
