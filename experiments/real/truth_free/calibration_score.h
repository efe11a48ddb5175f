// What the residuals of one pair say of its camera's faults.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "experiments/real/truth_free/camera_faults.h"

namespace rcme {

using FaultMatrix = Eigen::Matrix<double, kNumCameraFaults, kNumCameraFaults>;

// Score s and information A of the faults: A^-1 s is the Gauss-Newton step of the pair's self-calibration.
struct CalibrationScore {
  FaultVector score;
  FaultMatrix information;
};

// To first order a match's signed Sampson distance r = g / |J| is r = D theta + P q + noise: theta (11x1) the
// faults, q (5x1) what the answered motion is off, P = dr/dp. D (1x11) is the derivative, with its sign
// turned, of the distance of the match without the fault: X - theta d, d = dX/dtheta of camera_faults.h,
// whose noise is that of X times (I - theta d_X), so that r(theta) = g(X - theta d) / |J (I - theta d_X)| and
//
//   D = r_X d - r u' d_X u,  r_X = J / |J| - g J H / |J|^3 (1x4),  u = J' / |J|,
//
// H of sampson.h. Without the terms in r = u'n, n the noise, D would go with it, E[D r] = sigma^2 u' d_X u
// and so on: for the focal length, whose d is -(x - c), a bias of one standard deviation in every match, and
// faults are seen by hundredths of it. Weighted least squares in theta and q, q eliminated:
//
//   s = sum w r (D - B P)', A = sum w (D - B P)' D, B = (sum w D' P) (sum w P' P)^-1  (11x5),
//
// so that s does not feel to first order how the motion was estimated. The weight w of an inlier is its
// probability, where the estimator gives one, over its variance: the pair's noise (twin.h) times the match's
// noise_scale, squared. A is too great by the share of its information that wrong matches take: theta is then
// a little too small. Nothing where the inliers do not determine the motion.
std::optional<CalibrationScore> ScoreCalibration(const MotionProblem& problem,
                                                 const MotionEstimate& estimate);

// D of one match at a motion whose fundamental matrix is F, 1x11.
Eigen::Matrix<double, 1, kNumCameraFaults> ResidualByFaults(const Eigen::Matrix3d& F, const Camera& camera1,
                                                            const Camera& camera2,
                                                            const RelativePose& cam2_from_cam1,
                                                            const Correspondence& match);

}  // namespace rcme
