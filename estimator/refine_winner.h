#pragma once

#include "estimator/hypothesis.h"
#include "estimator/motion_estimate.h"
#include "estimator/ransac_options.h"

namespace rcme {

// Box 4 of the paper: refines the winner of the loop over its inlier set `support`, and fills motion,
// covariance, final inliers, the kappa flag and the status of `estimate`.
//
// The final inliers are the matches that agree with the refined motion (rank-aware, its covariance included).
void RefineWinner(const MotionProblem& problem, const RansacOptions& options, const Hypothesis& winner,
                  const std::vector<int>& support, MotionEstimate* estimate);

// Matches among `indices` whose reprojection error is below sigma^2 chi2_2(1 - alpha) (Sec. metric). The
// error is the squared Sampson distance, its first-order minimum over the point; Huber's function does not
// change the verdict as long as its corner lies at or beyond the threshold.
int CountConsistent(const MotionProblem& problem, const std::vector<int>& indices, const RelativePose& pose,
                    double significance_level);

}  // namespace rcme
