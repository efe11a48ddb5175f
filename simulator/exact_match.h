#pragma once

#include "estimator/geometry/correspondence.h"
#include "simulator/view_pair.h"

namespace rcme {

// The match of a point (camera 1's frame, m) before noise.
inline Correspondence ExactMatch(const ViewPair& view, const Eigen::Vector3d& point_in_cam1) {
  return {view.camera1.Project(point_in_cam1), view.camera2.Project(view.InCamera2(point_in_cam1))};
}

// The same in pinhole cameras of the same K: the undistorted match.
inline Correspondence PinholeMatch(const ViewPair& view, const Eigen::Vector3d& point_in_cam1) {
  const Camera &pinhole1 = view.camera1, &pinhole2 = view.camera2;
  return {pinhole1.Project(point_in_cam1), pinhole2.Project(view.InCamera2(point_in_cam1))};
}

}  // namespace rcme
