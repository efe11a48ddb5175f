// The motion of m >= 8 matches by linear least squares, with its first-order covariance: what a Hypothesis is
// to a minimal sample, for samples of any size. For studying the covariance; the loop keeps to eight points.
#pragma once

#include <optional>

#include "estimator/motion_problem.h"
#include "estimator/solvers/linear_fit.h"
#include "estimator/uncertainty/motion_covariance.h"

namespace rcme {

struct LinearMotion {
  LinearFit fit;                      // f
  std::array<RelativePose, 4> poses;  // of the essential matrix nearest to f; cheirality is not decided
  Matrix9d f_cov = Matrix9d::Zero();  // Sigma_f = G D G'

  // Sigma_f in the coordinates of fit.LocalCoordinates: A' Sigma_f A, regular.
  Matrix8d LocalCovarianceOfF() const { return fit.A.transpose() * f_cov * fit.A; }
};

// The unit vector f of a motion, f = vec([t]x R) / sqrt(2), up to its sign.
Vector9d ComputeLinearModel(const RelativePose& pose);

// From all matches of the problem. Nothing if they are degenerate: they determine no f, or no direction of
// translation.
std::optional<LinearMotion> EstimateLinearMotion(const MotionProblem& problem);

}  // namespace rcme
