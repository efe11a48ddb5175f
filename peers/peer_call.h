// From the call of a library to the estimate.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// A motion and what its library calls the inliers of it, in any order.
struct PeerAnswer {
  RelativePose cam2_from_cam1;
  std::vector<int> inliers;
};

// The matches, ascending, that agree with a motion at the assumed sigma: squared Sampson distance within
// ConsistencyThreshold(0.05) (estimator/motion_tests.h).
std::vector<int> MatchesThatAgree(const MotionProblem& problem, const RelativePose& pose);

// The first-order covariance of a maximum-likelihood fit to the inliers, at `pose` and with the assumed
// sigma; nothing where they determine no motion.
std::optional<Matrix5d> CovarianceOfInliers(const MotionProblem& problem, const RelativePose& pose,
                                            const std::vector<int>& inliers);

// The estimate that a library's answer is. The problem is checked before `ask` is called; nothing from it is
// no_candidate, an exception library_error with the library's words. The covariance is the first-order one
// of a maximum-likelihood fit to the inliers, at the library's motion and with the assumed sigma: what a user
// would report who has nothing but the inliers. Inliers that determine no motion are degenerate_matches.
MotionEstimate CallPeer(const MotionProblem& problem, int sample_size, const std::string& library,
                        const std::function<std::optional<PeerAnswer>()>& ask);

}  // namespace rcme
