// Describes a motion for people: the rotation and position of camera 2 in words and numbers.
#pragma once

#include <string>

#include "estimator/geometry/pose.h"
#include "estimator/motion_estimate.h"

namespace rcme {

// The rotation of camera 2 seen from camera 1 (x right, y down, z forward): angle and axis. `words` lists
// the parts about the axes that are at least a tenth of the angle, the greatest first: "11.9 deg to the
// right, 2.1 deg up, 1.3 deg clockwise".
struct Turn {
  double angle_deg = 0.0;
  Eigen::Vector3d axis_in_cam1 = Eigen::Vector3d::UnitY();
  std::string words;
};
Turn ComputeTurn(const Eigen::Matrix3d& cam2_from_cam1_R);

// ComputePlace returns the direction to camera 2, a unit vector in camera 1's frame: -R't. DescribePlace
// names the axes along which it has at least 0.3, the greatest first: "right, forward".
Eigen::Vector3d ComputePlace(const RelativePose& cam2_from_cam1);
std::string DescribePlace(const RelativePose& cam2_from_cam1);

// Standard deviations and 95 % regions in deg, from a covariance [rotation, direction] in rad^2.
struct MotionSpread {
  double angle_sd_deg = 0.0;         // of the rotation angle, about its axis
  Eigen::Vector3d rotation_95_deg;   // semi-axes of the 95 % ellipsoid of the rotation, greatest first
  Eigen::Vector2d direction_sd_deg;  // along the axes of the ellipse of the direction, greater first
  Eigen::Vector2d direction_95_deg;  // semi-axes of its 95 % ellipse
};
MotionSpread ComputeSpread(const RelativePose& cam2_from_cam1, const Matrix5d& pose_cov);

// Returns the likeliest other motion, or nullptr if there is none. Two searches may end in the same optimum,
// so modes within a tenth of the answer's standard deviation are ignored.
const MotionMode* FindRunnerUp(const MotionEstimate& estimate);

}  // namespace rcme
