// How far the truth lies from an estimate, measured with the covariance that the estimate reports: tangent
// and covariance are both those at the estimate, as a user of the covariance has them. Infinite or NaN: the
// covariance is invalid, and covers nothing.
#pragma once

#include "estimator/linear_motion.h"

namespace rcme {

// Of the four motions of an essential matrix the one nearest to the truth. Which of the four is right is a
// question to all matches of an image pair and has an answer of its own kind; the covariance describes none
// of it.
RelativePose NearestPose(const std::array<RelativePose, 4>& poses, const RelativePose& pose_true);

// NEES of Sigma_f, 8 degrees of freedom.
double NormalizedErrorOfF(const LinearMotion& estimate, const RelativePose& pose_true);

// NEES of Sigma_p, 5 degrees of freedom.
double NormalizedErrorOfPose(const RelativePose& estimate, const Matrix5d& pose_cov,
                             const RelativePose& pose_true);

}  // namespace rcme
