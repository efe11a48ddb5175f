// How far errors of the calibration would move a motion. Estimators take the intrinsics as exact, unless the
// options focal_sd, principal_point_sd_px and distortion_sd state their standard deviations.
#pragma once

#include <string>
#include <vector>

#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"
#include "experiments/study/estimator_spec.h"

namespace rcme {

// Root mean squares, over errors of one intrinsic with standard deviation `sd`, of the angles by which
// rotation and direction move. A direction that the error may turn anywhere moves by some 90 deg.
struct CalibrationEffect {
  std::string error;   // for people: "1 % of the focal length"
  std::string option;  // that states the standard deviation
  double sd = 0.0;     // in the unit of the option
  double rotation_rms_deg = 0.0, direction_rms_deg = 0.0;
};

// Returns whether the covariance of an estimator with these options has errors of the calibration that they
// state. That which the estimator itself makes (covariance: own) has none.
bool CanStateCalibrationErrors(const EstimatorSpec& spec);
bool StatesCalibrationErrors(const EstimatorSpec& spec);

// The effects of 1 % of the focal length, 5 px of the principal point and 0.01 of k1 on the motion that fits
// the inliers of `estimate` (status ok), to first order (estimator/uncertainty/calibration_prior.h). Empty if
// the inliers determine no motion.
std::vector<CalibrationEffect> ComputeCalibrationEffects(const MotionProblem& problem,
                                                         const MotionEstimate& estimate);

}  // namespace rcme
