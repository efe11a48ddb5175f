#pragma once

#include <utility>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/scene_camera.h"

namespace rcme {

// The two cameras of every trial of a condition: the interface of the files in simulator/cameras.
class CameraModel {
 public:
  virtual ~CameraModel() = default;
  virtual std::vector<Parameter> Parameters() { return {}; }
  virtual std::pair<SceneCamera, SceneCamera> Make() const = 0;  // of image 1 and of image 2
};

}  // namespace rcme
