// The normal equations of a pure rotation, one match at a time, in pixels: x2 = h(x1), h the image of the
// rotated ray. The fast implementation is kernels/rotation_equations.h.
//
// Both points carry noise. The residual e = x2 - h(x1) has covariance C = sigma^2 (I + J J'), J = dh/dx1
// (2x2), so to first order d2 = e' C^-1 e follows chi2_2 under the true rotation.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// Sums over a set of matches. The rotation moves as in Retract, R <- Exp(w) R (rad).
struct RotationEquations {
  double energy = 0.0;                                 // sum d2
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();  // - sum weight G' C^-1 e, G = dh/dw
  Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();   // sum weight G' C^-1 G
};

// The weight is 1, or Cauchy's 1 / (1 + d2 / c^2). Matches that the rotation takes behind camera 2 are left
// out.
RotationEquations LinearizeRotation(const MotionProblem& problem, std::span<const int> indices,
                                    const Eigen::Matrix3d& R, Loss loss);

// The matches with d2 <= threshold that the rotation does not take behind camera 2, ascending.
std::vector<int> FindRotated(const MotionProblem& problem, const Eigen::Matrix3d& R, double threshold);

}  // namespace rcme
