// Maximum-likelihood refinement: least squares of the reprojection error over the motion and one point per
// match.
//
// Under a.2 and without outliers this is the maximum-likelihood estimate. pose_cov is the inverse of its
// Fisher information with the points marginalised (Schur complement): 5x5, [rotation, direction], rad^2. With
// outliers among the matches neither statement holds.
#pragma once

#include <span>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "estimator/refinement/motion_search.h"

namespace rcme {

// Solved by Ceres; points are (u, v, inverse depth) in camera 1, eliminated by Schur complement. `indices`
// names the matches to use, at least five. Stops when a step lowers the cost by less than the share
// `function_tolerance` of it.
RefinedMotion RefineByReprojection(const MotionProblem& problem, std::span<const int> indices,
                                   const RelativePose& start, Loss loss, double function_tolerance = 1e-10);

}  // namespace rcme
