// The contribution of an uncertain calibration to the covariance of a motion.
#pragma once

#include <functional>

#include "estimator/geometry/pose.h"
#include "estimator/motion_problem.h"
#include "parameters/parameter.h"

namespace rcme {

// Standard deviations of the intrinsics. Two cameras have independent errors; a single camera that took both
// images (IsOfOneCamera) has the same errors in both.
struct CalibrationPrior {
  double focal_sd = 0.0;               // relative
  double principal_point_sd_px = 0.0;  // per coordinate
  // Of k1 of the lens (geometry/lens.h); without one, a ray (x, y, 1) is imaged as (1 + k1 (x^2 + y^2)) (x,
  // y).
  double distortion_sd = 0.0;
  // Maps a shift in the pixels of principal_point_sd_px to the problem's pixels of images 1 and 2: those of
  // cameras turned about their optical axes.
  Eigen::Matrix2d of_pixels1 = Eigen::Matrix2d::Identity(), of_pixels2 = Eigen::Matrix2d::Identity();

  bool IsNone() const { return focal_sd == 0.0 && principal_point_sd_px == 0.0 && distortion_sd == 0.0; }
};

// Whether one camera took both images: K is equal to a relative 1e-4, as each image of a reconstruction may
// have its own rounded one, and the lenses are equal.
bool IsOfOneCamera(const MotionProblem& problem);

Parameter FocalParameter(double* focal_sd);
Parameter PrincipalPointParameter(double* principal_point_sd_px);
Parameter DistortionParameter(double* distortion_sd);

// G Sigma_K G', 5x5 [rotation, direction], rad^2. A motion at which the gradient g(p, K) of a cost vanishes
// moves with K by G = dp/dK = -H^-1 dg/dK (implicit function theorem), H the Hessian of the cost. dg/dK is
// computed by finite differences; a step moves the points by a small part of their noise. `gradient_of` gives
// g at the motion for a problem with other intrinsics, or with matches undistorted by another lens.
Matrix5d CalibrationCovariance(const MotionProblem& problem, const CalibrationPrior& prior,
                               const Matrix5d& inverse_hessian,
                               const std::function<Vector5d(const MotionProblem&)>& gradient_of);

}  // namespace rcme
