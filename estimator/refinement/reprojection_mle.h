// Maximum-likelihood refinement: least squares of the reprojection error over the motion and one point per
// match.
//
// Under a.2 and without outliers the result is the maximum-likelihood estimate, and pose_cov is the inverse
// of its Fisher information with the points marginalised (Schur complement): 5x5, [rotation, direction],
// rad^2. With outliers among the matches neither holds.
#pragma once

#include <span>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"

namespace rcme {

enum class Loss {
  kSquared,
  kCauchy,  // scale 2.385 sigma: 95 % efficient for Gaussian noise
};

struct RefinedMotion {
  bool converged = false;  // false: no finite optimum; the other fields are then the start
  RelativePose cam2_from_cam1;
  Matrix5d pose_cov = Matrix5d::Zero();
  int num_iterations = 0;
};

// Ceres, points as (u, v, inverse depth) in camera 1 and eliminated by Schur complement. `indices` names the
// matches to use, at least five. Stops when a step lowers the cost by less than `function_tolerance` of it.
RefinedMotion RefineByReprojection(const MotionProblem& problem, std::span<const int> indices,
                                   const RelativePose& start, Loss loss, double function_tolerance = 1e-10);

}  // namespace rcme
