// The terms of one match under a motion in plain formulas: the scalar twin of kernels/mixture_sums.h,
// kernels/depth_in_noise-inl.h and kernels/soft_score.h, for tests. The match is `noise_scale` times as noisy
// as the others: the fields hold r', z', dr' / dp and the density of r' of mixture_parameters.h.
#pragma once

#include "estimator/calibrated/mixture_parameters.h"
#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

struct MatchTerms {
  double residual = 0.0;                   // r = g / |J|, in units of the assumed sigma
  Vector5d derivative = Vector5d::Zero();  // dr / dp = (g_p - (g / |J|^2) J J_p) / |J|
  // The parallax within the epipolar plane, positive in front of a camera, over the noise of the angle
  // between two rays: the smaller value of the two cameras (z), and their mean.
  double depth = 0.0, mean_depth = 0.0;
};
MatchTerms EvaluateMatch(const MotionProblem& problem, const RelativePose& pose, const Correspondence& match,
                         double noise_scale = 1.0);

// The mixture density of a match, and the terms that its maximisation needs.
struct MatchDensity {
  double density = 0.0;    // p(r, z), per unit of the assumed sigma
  double right = 0.0;      // p, the probability that the match is an inlier
  double weight = 0.0;     // v = 2k / (2k - 1 + u^2), u = r / s
  double curvature = 0.0;  // max(p psi' - p (1 - p) psi^2, 0.6 p v), psi = v u
};
MatchDensity EvaluateDensity(double residual, double depth, const MixtureParameters& parameters,
                             double noise_scale = 1.0);

// v = 1 / (1 + r^2 / s^2)
double SoftScore(double residual, double scale);

}  // namespace rcme
