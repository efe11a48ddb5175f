// What an uncertain calibration adds to the covariance of a motion.
#pragma once

#include <functional>
#include <vector>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "parameters/parameter.h"

namespace rcme {

// Standard deviations of the intrinsics, of both cameras independently; of one camera that took both images,
// whose intrinsics are the same in both, of that camera.
struct CalibrationPrior {
  double focal_sd = 0.0;               // relative
  double principal_point_sd_px = 0.0;  // per coordinate
  double distortion_sd = 0.0;          // of k1: a ray (x, y, 1) is imaged as (1 + k1 (x^2 + y^2)) (x, y)

  bool IsNone() const { return focal_sd == 0.0 && principal_point_sd_px == 0.0 && distortion_sd == 0.0; }
};

Parameter FocalParameter(double* focal_sd);
Parameter PrincipalPointParameter(double* principal_point_sd_px);
Parameter DistortionParameter(double* distortion_sd);

// G Sigma_K G', 5x5 [rotation, direction], rad^2. A motion at which the gradient g(p, K) of a cost vanishes
// moves with K by G = dp/dK = -H^-1 dg/dK (implicit function theorem), H the Hessian of the cost; dg/dK by
// differences, with a step that moves the points by little of their noise. `gradient_of` is g at the motion,
// of a problem with other intrinsics or, as if undistorted, other matches.
Matrix5d CalibrationCovariance(const MotionProblem& problem, const CalibrationPrior& prior,
                               const Matrix5d& inverse_hessian,
                               const std::function<Vector5d(const MotionProblem&)>& gradient_of);

}  // namespace rcme
