// A problem in coordinates in which anisotropic noise (noise_shape.h) is isotropic, and the way back.
//
// Let s^2 S be the covariance of the noise in pixels, K the focal lengths diag(fx, fy), and
// K^-1 S K^-1 = V L V' with V a rotation. The noise of V' K^-1 x has the covariance s^2 L, so that
// x' = L^(-1/2) V' K^-1 x has isotropic noise. x' is the pixel of a camera with the focal lengths L^(-1/2)
// that is turned about its optical axis: a ray a becomes T a, T = diag(V', 1). With T1 and T2 for the two
// cameras a motion [R t] becomes [T2 R T1', T2 t]. Distances between points, and parts of the image, are then
// those of turned and stretched pixels.
#pragma once

#include <optional>

#include "estimator/calibrated/motion_posterior.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

class WhitenedProblem {
 public:
  // `shape`: S, 2x2, positive definite. It is scaled to a trace of 2, so that sigma_px stays the root mean
  // square of the noise per coordinate.
  WhitenedProblem(const MotionProblem& problem, const Eigen::Matrix2d& shape);

  const MotionProblem& problem() const { return problem_; }
  // Maps a shift in the pixels of the original image to those of the problem.
  const Eigen::Matrix2d& of_pixels1() const { return of_pixels1_; }
  const Eigen::Matrix2d& of_pixels2() const { return of_pixels2_; }
  // The estimate and the posterior in the frames and pixels of the original problem.
  void Restore(MotionEstimate* estimate) const;
  void Restore(MotionPosterior* posterior) const;

 private:
  RelativePose Restored(const RelativePose& pose) const;
  // 5x5: maps the tangent at a whitened pose to that at the restored one.
  Matrix5d TangentMap(const RelativePose& whitened) const;

  MotionProblem problem_;
  Eigen::Matrix3d turn1_, turn2_;  // T1, T2
  Eigen::Matrix2d of_pixels1_, of_pixels2_;
};

}  // namespace rcme
