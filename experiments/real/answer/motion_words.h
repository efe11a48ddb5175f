// A motion for people: how camera 2 is turned and where it stands, in words and numbers.
#pragma once

#include <string>

#include "estimator/geometry/pose.h"
#include "estimator/motion_estimate.h"

namespace rcme {

// Of the rotation of camera 2, seen from camera 1 (x right, y down, z forward), its angle and axis; in words
// its parts about the axes, the greatest first, those of at least a tenth of it: "11.9 deg to the right,
// 2.1 deg up, 1.3 deg clockwise".
struct Turn {
  double angle_deg = 0.0;
  Eigen::Vector3d axis_in_cam1 = Eigen::Vector3d::UnitY();
  std::string words;
};
Turn ComputeTurn(const Eigen::Matrix3d& cam2_from_cam1_R);

// Where camera 2 stands, a unit vector in camera 1's frame: -R't; in words the sides that it is at by at
// least 0.3, the greatest first: "right, forward".
Eigen::Vector3d ComputePlace(const RelativePose& cam2_from_cam1);
std::string DescribePlace(const RelativePose& cam2_from_cam1);

// Standard deviations and 95 % regions, deg, from a covariance [rotation, direction] in rad^2.
struct MotionSpread {
  double angle_sd_deg = 0.0;         // of the rotation's angle, about its axis
  Eigen::Vector3d rotation_95_deg;   // semi-axes of the rotation's 95 % ellipsoid, the greatest first
  Eigen::Vector2d direction_sd_deg;  // along the axes of the direction's ellipse, the greater first
  Eigen::Vector2d direction_95_deg;  // its 95 % ellipse
};
MotionSpread ComputeSpread(const RelativePose& cam2_from_cam1, const Matrix5d& pose_cov);

// The likeliest other motion; none: nullptr. Two starts may end in one optimum: what is within a tenth of the
// answer's standard deviation of it is no other motion.
const MotionMode* FindRunnerUp(const MotionEstimate& estimate);

}  // namespace rcme
