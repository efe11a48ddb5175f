// Evidence for camera faults in the residuals of one pair.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "experiments/real/truth_free/camera_faults.h"

namespace rcme {

using FaultMatrix = Eigen::Matrix<double, kNumCameraFaults, kNumCameraFaults>;

// Score s and information A of the faults. A^-1 s is the Gauss-Newton step of self-calibration from this
// pair.
struct CalibrationScore {
  FaultVector score;
  FaultMatrix information;
};

// To first order the signed Sampson distance r = g / |J| of a match is r = D theta + P q + noise. Here theta
// (11x1) holds the faults, q (5x1) is the error of the estimated motion, and P = dr/dp. Removing the faults
// moves the match X to X - theta d, with d = dX/dtheta of camera_faults.h, and multiplies its noise by
// (I - theta d_X). Hence r(theta) = g(X - theta d) / |J (I - theta d_X)|, and D (1x11) is its negative
// derivative:
//
//   D = r_X d - r u' d_X u,  r_X = J / |J| - g J H / |J|^3 (1x4),  u = J' / |J|,
//
// with H of sampson.h. The terms in r = u'n, n the noise, are needed: without them D is correlated with the
// noise, E[D r] = sigma^2 u' d_X u and so on. For the focal length, whose d is -(x - c), that is a bias of
// one standard deviation in every match, while faults of some hundredths of it are to be detected. Weighted
// least squares in theta and q, with q eliminated, gives
//
//   s = sum w r (D - B P)', A = sum w (D - B P)' D, B = (sum w D' P) (sum w P' P)^-1  (11x5),
//
// so that to first order s does not depend on the error of the estimated motion. The weight w of an inlier is
// its probability (1 if the estimator gives none) over its variance, the square of the pair's noise
// (EstimateNoise in twin.h) times the match's noise_scale. Wrong matches among the inliers add to A without
// adding to s, so theta comes out slightly too small. nullopt: fewer than 20 inliers, or inliers that do not
// determine the motion.
std::optional<CalibrationScore> ScoreCalibration(const MotionProblem& problem,
                                                 const MotionEstimate& estimate);

// D (1x11) of one match. F: the fundamental matrix of `cam2_from_cam1`.
Eigen::Matrix<double, 1, kNumCameraFaults> ResidualByFaults(const Eigen::Matrix3d& F, const Camera& camera1,
                                                            const Camera& camera2,
                                                            const RelativePose& cam2_from_cam1,
                                                            const Correspondence& match);

}  // namespace rcme
