// Step 8 of rcme_calibrated: the covariance of a mode.
#pragma once

#include "estimator/calibrated/calibrated_options.h"
#include "estimator/calibrated/explanation.h"
#include "estimator/calibrated/mixture_fit.h"
#include "estimator/motion_problem.h"

namespace rcme {

// H^-1, H the Hessian of the likelihood at the optimum by central differences of its gradient, a tenth of a
// standard deviation either way. Where the parallax is small the noise seems to determine the direction
// (observability.h); the residuals' second derivatives, which this Hessian has, take that away again. Of the
// posterior where the motion has a prior: H has its part.
Matrix5d InverseOfObserved(const MatchBlocks& matches, const Mode& mode, const MixturePrior& prior = {});

// Along each column of `axes` (H^-1 times a unit vector), how many matches the variance rests on: (sum c)^2 /
// sum c^2, c the part of it that a match has (Kish 1965).
Vector5d EffectiveMatches(const Mode& mode, const Explanation& explanation, const Matrix5d& axes);

// H^-1 S H^-1 with S = sum (p psi / ((1 - h) s))^2 J'J, psi = v u: the residuals give their own variances,
// and a residual with leverage h is smaller than its error by 1 - h (HC3, MacKinnon and White 1985). Where
// along some direction the mean variance of all residuals gives a greater S, that one: few matches, that
// decide, have a poor estimate of their own variance. Beside this what a match in doubt adds: that it is
// wrong, with probability w (influence.h), moves the motion by H^-1 J' psi / ((1 - h) s) and takes its
// information away, so that by the law of total variance S grows by w (psi^2 / (1 - h)^2 + p v / (1 - h)) /
// s^2 J'J. Along each principal axis times k / (k - 2), as the variance is estimated: k the effective number
// of matches of the axis where these are fewer than thirty, else the degrees of freedom. 5x5 [rotation,
// direction], rad^2. The mode's inverse information where the result is not finite. Where the motion has a
// prior this is what the noise of the matches makes of the covariance; PriorCovariance is the other part.
Matrix5d SandwichCovariance(const Mode& mode, const Explanation& explanation,
                            const Matrix5d& inverse_of_observed);

// What the noise of the prior's measurements adds: their score J' r (motion_prior.h) has the variance J' J,
// as r is N(0, I), and moves the motion by H^-1 J' r, so that this is H^-1 J' J H^-1. Zero without a prior.
Matrix5d PriorCovariance(const Mode& mode, const MixturePrior& prior, const Matrix5d& inverse_of_observed);

// Of a covariance of the optimum of the matches alone, of whatever kind, what it is of the optimum with the
// prior: H^-1 (M C M + J' J) H^-1, M the information of the matches; the same without a prior.
Matrix5d CovarianceWithPrior(const Matrix5d& covariance_of_matches, const Mode& mode,
                             const MixturePrior& prior);

// What uncertain intrinsics add (uncertainty/calibration_prior.h), of the mixture's likelihood.
Matrix5d IntrinsicsCovariance(const MotionProblem& problem, const CalibratedOptions& options,
                              const Mode& mode, const Matrix5d& inverse_of_observed);

}  // namespace rcme
