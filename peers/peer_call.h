// Converts the answer of another library to an estimate.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

// A motion and its inliers according to the library, in any order.
struct PeerAnswer {
  RelativePose cam2_from_cam1;
  std::vector<int> inliers;
};

// The matches, ascending, that agree with a motion at the assumed sigma: squared Sampson distance over
// sigma^2 within ConsistencyThreshold(0.05) (estimator/motion_tests.h).
std::vector<int> MatchesThatAgree(const MotionProblem& problem, const RelativePose& pose);

// The first-order covariance of a maximum-likelihood fit to the inliers, at `pose` and with the assumed
// sigma; nullopt if they do not determine a motion.
std::optional<Matrix5d> CovarianceOfInliers(const MotionProblem& problem, const RelativePose& pose,
                                            const std::vector<int>& inliers);

// Calls a library through `ask` and converts its answer to an estimate. The problem is checked first. If
// `ask` returns nullopt the status is no_candidate; an exception is library_error with the library's message.
// The covariance is CovarianceOfInliers at the library's motion, which is what a user with only the inliers
// would report. If the inliers do not determine a motion, the status is degenerate_matches.
MotionEstimate CallPeer(const MotionProblem& problem, int sample_size, const std::string& library,
                        const std::function<std::optional<PeerAnswer>()>& ask);

}  // namespace rcme
