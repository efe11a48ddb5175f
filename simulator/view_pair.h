#pragma once

#include <Eigen/Core>

#include "estimator/geometry/pose.h"
#include "simulator/scene_camera.h"

namespace rcme {

// Two cameras and the motion between them, with its length.
struct ViewPair {
  SceneCamera camera1, camera2;
  RelativePose cam2_from_cam1_true;  // |t| = 1; t is arbitrary if the baseline is zero
  double baseline_m = 0.0;           // length of the translation

  // A pure rotation has no direction of translation.
  bool IsDirectionDefined() const { return baseline_m > 0.0; }

  Eigen::Vector3d InCamera2(const Eigen::Vector3d& point_in_cam1) const {
    return cam2_from_cam1_true.R * point_in_cam1 + baseline_m * cam2_from_cam1_true.t;
  }

  // Whether both images show the point.
  bool Sees(const Eigen::Vector3d& point_in_cam1) const {
    return camera1.Shows(point_in_cam1) && camera2.Shows(InCamera2(point_in_cam1));
  }
};

}  // namespace rcme
