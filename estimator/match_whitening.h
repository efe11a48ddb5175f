#pragma once

#include "estimator/motion_problem.h"

namespace rcme {

// Scale from whitened coordinates to rays, sigma / focal length: ray = [scale.x x, scale.y y, 1].
struct RayScale {
  double x1, y1, x2, y2;
};

// Maps pixels to whitened coordinates: offset from the principal point over sigma, so that the noise has
// variance 1.
class MatchWhitening {
 public:
  explicit MatchWhitening(const MotionProblem& problem);

  Eigen::Vector2d WhitenPoint1(const Eigen::Vector2d& x1_px) const { return inverse_sigma_ * (x1_px - c1_); }
  Eigen::Vector2d WhitenPoint2(const Eigen::Vector2d& x2_px) const { return inverse_sigma_ * (x2_px - c2_); }
  const RayScale& ray_scale() const { return ray_scale_; }

  // F with x2' F x1 = 0 in whitened coordinates, from E in rays (eq::model_motion_relation). The map is
  // linear, so it also maps derivatives of E.
  Eigen::Matrix3d FundamentalFromEssential(const Eigen::Matrix3d& E) const;

 private:
  Eigen::Vector2d c1_, c2_;  // principal points, px
  double inverse_sigma_;     // 1 / px
  RayScale ray_scale_;
};

}  // namespace rcme
