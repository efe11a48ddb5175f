// A problem in coordinates in which anisotropic noise (noise_shape.h) is isotropic, and the way back.
//
// Let s^2 S be the covariance of the noise in pixels, K the focal lengths diag(fx, fy), and
// K^-1 S K^-1 = V L V' with V a rotation. The noise of V' K^-1 x has the covariance s^2 L, so that
// x' = L^(-1/2) V' K^-1 x has isotropic noise. x' is the pixel of a camera with the focal lengths L^(-1/2)
// that is turned about its optical axis: a ray a becomes T a, T = diag(V', 1). With T1 and T2 for the two
// cameras a motion [R t] becomes [T2 R T1', T2 t].
#pragma once

#include <optional>

#include "estimator/calibrated/motion_posterior.h"
#include "estimator/motion_estimate.h"
#include "estimator/motion_problem.h"

namespace rcme {

class WhitenedProblem {
 public:
  // `shape`: S, 2x2, positive definite. It is scaled to a determinant of 1, so that sigma_px is the geometric
  // mean of the standard deviations along the axes.
  WhitenedProblem(const MotionProblem& problem, const Eigen::Matrix2d& shape);

  const MotionProblem& problem() const { return problem_; }
  // The estimate and the posterior in the frames and pixels of the original problem.
  void Restore(MotionEstimate* estimate) const;
  void Restore(MotionPosterior* posterior) const;

 private:
  RelativePose Restored(const RelativePose& pose) const;
  // 5x5: maps the tangent at a whitened pose to that at the restored one.
  Matrix5d TangentMap(const RelativePose& whitened) const;

  MotionProblem problem_;
  Eigen::Matrix3d turn1_, turn2_;  // T1, T2
  double rms_over_sigma_;          // root mean square of the noise per coordinate over sigma_px
};

}  // namespace rcme
