#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/pose.h"
#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// The truth of one trial: two cameras, their motion, and points that both see.
struct Scene {
  Camera camera1, camera2;
  RelativePose cam2_from_cam1_true;             // |t| = 1
  double baseline_m = 0.0;                      // length of the translation
  std::vector<Eigen::Vector3d> points_in_cam1;  // metres

  Eigen::Vector3d InCamera2(const Eigen::Vector3d& point_in_cam1) const {
    return cam2_from_cam1_true.R * point_in_cam1 + baseline_m * cam2_from_cam1_true.t;
  }
};

// A family of scenes with its parameters; scene_registry lists them. Configured once, then const and shared
// by threads.
class SceneModel {
 public:
  virtual ~SceneModel() = default;
  // The parameters by name; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  // One scene, from a stream of its own, of which more may be drawn than is used. Throws InputError that
  // names the keys if the parameters admit no such scene.
  virtual Scene Generate(RandomStream& rng) const = 0;
};

}  // namespace rcme
