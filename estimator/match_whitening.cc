#include "estimator/match_whitening.h"

namespace rcme {

MatchWhitening::MatchWhitening(const MotionProblem& problem)
    : c1_(problem.camera1.cx, problem.camera1.cy),
      c2_(problem.camera2.cx, problem.camera2.cy),
      inverse_sigma_(1.0 / problem.sigma_px),
      ray_scale_{problem.sigma_px / problem.camera1.fx, problem.sigma_px / problem.camera1.fy,
                 problem.sigma_px / problem.camera2.fx, problem.sigma_px / problem.camera2.fy} {}

// eq::model_motion_relation.
Eigen::Matrix3d MatchWhitening::FundamentalFromEssential(const Eigen::Matrix3d& E) const {
  return Eigen::Vector3d(ray_scale_.x2, ray_scale_.y2, 1.0).asDiagonal() * E *
         Eigen::Vector3d(ray_scale_.x1, ray_scale_.y1, 1.0).asDiagonal();
}

}  // namespace rcme
