#pragma once

#include "simulator/scene.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {

// The camera moves sideways without turning: every other of 100 points is infinitely far away, and against
// these the rest, at depth fx baseline / distance, move by `distance_px` in image 2.
inline Scene FarAndNearScene(double distance_px) {
  Scene scene;
  scene.camera1 = TestCamera1();
  scene.camera2 = TestCamera2();
  scene.cam2_from_cam1_true = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()};
  scene.baseline_m = 0.5;
  RandomStream rng({.seed = 1, .purpose = 93});
  for (int i = 0; i < 100; ++i) {
    const double depth_m = i % 2 == 0 ? 1e9 : scene.camera2.fx * scene.baseline_m / distance_px;
    scene.points_in_cam1.push_back(depth_m *
                                   scene.camera1.Ray({rng.Uniform(0.0, 640.0), rng.Uniform(0.0, 480.0)}));
  }
  return scene;
}

}  // namespace rcme
