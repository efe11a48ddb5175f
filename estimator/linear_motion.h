// The motion of m >= 8 matches by linear least squares, with its first-order covariance. It serves studies of
// the covariance as a function of m; the loop's linear solver takes eight points (solvers/eight_point.h).
#pragma once

#include <optional>

#include "estimator/motion_problem.h"
#include "estimator/solvers/linear_fit.h"
#include "estimator/uncertainty/motion_covariance.h"

namespace rcme {

struct LinearMotion {
  LinearFit fit;                      // f
  std::array<RelativePose, 4> poses;  // the four of the essential matrix nearest to f
  Matrix9d f_cov = Matrix9d::Zero();  // Sigma_f = G D G'

  // Sigma_f in the coordinates of fit.LocalCoordinates: A' Sigma_f A (8x8, regular).
  Matrix8d LocalCovarianceOfF() const { return fit.A.transpose() * f_cov * fit.A; }
};

// The unit vector f of a motion, f = vec([t]x R) / sqrt(2); f and -f are the same model.
Vector9d ComputeLinearModel(const RelativePose& pose);

// The motion of all matches of the problem. nullopt if they do not determine f or the direction of
// translation.
std::optional<LinearMotion> EstimateLinearMotion(const MotionProblem& problem);

}  // namespace rcme
