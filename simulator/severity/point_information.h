// The information of one exact match about the motion, computed from projections alone.
#pragma once

#include <Eigen/Core>

#include "simulator/view_pair.h"

namespace rcme {

// A match has four pixel coordinates, and its point has three unknowns. The one remaining number c does not
// depend on the position of the point: d c = gradient_px' [d x1; d x2] = gradient_motion d p. With
// independent noise sigma its information about p (rotation 3, direction 2; rad) is gradient_motion'
// gradient_motion / (sigma^2 |gradient_px|^2).
struct PointConstraint {
  Eigen::Vector4d gradient_px;
  Eigen::Matrix<double, 1, 5> gradient_motion;
  Eigen::Vector2d line_direction;  // in image 2: how the point moves with its depth (not normalised)
};
PointConstraint ComputePointConstraint(const ViewPair& view, const Eigen::Vector3d& point_in_cam1);

// Without translation the depth has no effect and two numbers remain: the information about the rotation
// (3x3, rad^-2).
Eigen::Matrix3d ComputeRotationInformation(const ViewPair& view, const Eigen::Vector3d& point_in_cam1,
                                           double sigma_px);

}  // namespace rcme
