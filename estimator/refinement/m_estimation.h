// M-estimation of the motion over all matches including outliers (Huber 1964, 1981; Zhang 1997 for epipolar
// geometry). It minimises sum rho(r) of the Sampson residuals r = g / (sigma |J|), sigma that of the match
// (MotionProblem::noise_scale), by reweighted least squares from a start that is already near.
//
//   huber   rho = r^2 / 2 for |r| <= c, c |r| - c^2 / 2 beyond    weight 1, c / |r|
//   tukey   rho = c^2 / 6 (1 - (1 - r^2 / c^2)^3), c^2 / 6 beyond  weight (1 - r^2 / c^2)^2, 0
//
// The noise level is known, so r needs no scale estimate. With c = 1.345 and 4.685 the efficiency is 95 % of
// that of least squares if all noise is Gaussian.
#pragma once

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

enum class RobustLoss { kHuber, kTukey };

struct MEstimation {
  RobustLoss loss = RobustLoss::kTukey;
  double tuning_constant = 0.0;  // c, in standard deviations; 0: 95 % efficiency
  double TuningConstantOrDefault() const;
};

// rho(r), psi = rho', psi / r and psi'.
struct RobustTerms {
  double rho = 0.0, psi = 0.0, weight = 0.0, slope = 0.0;
};
RobustTerms EvaluateRobustLoss(const MEstimation& options, double r);

// Minimises from `start`. pose_cov is the first-order sandwich A^-1 B A^-1, A = sum psi' r_p' r_p, B = sum
// psi^2 r_p' r_p (Huber 1981, section 6.3), which takes the spread of psi from the matches. Not converged if
// A is not positive definite, or fewer than six matches have a weight.
RefinedMotion RefineByMEstimation(const MotionProblem& problem, const RelativePose& start,
                                  const MEstimation& options);

}  // namespace rcme
