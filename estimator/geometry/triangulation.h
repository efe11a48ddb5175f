#pragma once

#include <span>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/pose.h"

namespace rcme {

// Inverse depth of the point on ray1 (third component 1, camera 1's frame, baseline 1) whose image in camera
// 2 fits ray2 best: least squares of ray2 x (R ray1 + rho t) over rho. Zero for a point at infinity; negative
// behind camera 1.
double InverseDepth(const RelativePose& cam2_from_cam1, const Eigen::Vector3d& ray1,
                    const Eigen::Vector3d& ray2);

// Cheirality: the triangulated point lies in front of both cameras.
bool IsInFrontOfBothCameras(const RelativePose& cam2_from_cam1, const Eigen::Vector3d& ray1,
                            const Eigen::Vector3d& ray2);

// The pose with the most matches in front of both cameras; of equal ones the first.
RelativePose SelectPoseByCheirality(std::span<const RelativePose> poses,
                                    std::span<const Correspondence> matches, const Camera& camera1,
                                    const Camera& camera2);

}  // namespace rcme
