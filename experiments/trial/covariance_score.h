// NEES (normalized estimation error squared): the distance of the truth from an estimate, measured with the
// covariance that the estimate states. Tangent and covariance are those at the estimate, which is all that a
// user of the covariance has. Infinite or NaN means that the covariance is invalid and covers nothing.
#pragma once

#include "estimator/linear_motion.h"

namespace rcme {

// Returns the motion nearest to the truth of the four motions of an essential matrix. The covariance does
// not describe the choice among the four, which all matches of an image pair decide together.
RelativePose NearestPose(const std::array<RelativePose, 4>& poses, const RelativePose& pose_true);

// NEES of Sigma_f; 8 degrees of freedom.
double NormalizedErrorOfF(const LinearMotion& estimate, const RelativePose& pose_true);

// NEES of Sigma_p; 5 degrees of freedom.
double NormalizedErrorOfPose(const RelativePose& estimate, const Matrix5d& pose_cov,
                             const RelativePose& pose_true);

}  // namespace rcme
