// The information of one exact match about the motion, from projections alone.
#pragma once

#include <Eigen/Core>

#include "simulator/view_pair.h"

namespace rcme {

// Four pixels measure a match, three of them go into its point; what is left is one number c with
// d c = gradient_px' [d x1; d x2] = gradient_motion d p, the one combination of pixels that does not depend
// on where the point is. With independent noise sigma its information on p (rotation 3, direction 2; rad) is
// gradient_motion' gradient_motion / (sigma^2 |gradient_px|^2).
struct PointConstraint {
  Eigen::Vector4d gradient_px;
  Eigen::Matrix<double, 1, 5> gradient_motion;
  Eigen::Vector2d line_direction;  // in image 2: where the point moves with its depth (not of length 1)
};
PointConstraint ComputePointConstraint(const ViewPair& view, const Eigen::Vector3d& point_in_cam1);

// Without translation the depth is free and two numbers are left: the information on the rotation (3x3,
// rad^-2).
Eigen::Matrix3d ComputeRotationInformation(const ViewPair& view, const Eigen::Vector3d& point_in_cam1,
                                           double sigma_px);

}  // namespace rcme
