#pragma once

#include <utility>
#include <vector>

#include "estimator/geometry/camera.h"
#include "parameters/parameter.h"

namespace rcme {

// The two cameras of every trial of a condition: the plug-in contract of simulator/cameras.
class CameraModel {
 public:
  virtual ~CameraModel() = default;
  virtual std::vector<Parameter> Parameters() { return {}; }
  virtual std::pair<Camera, Camera> Make() const = 0;  // of image 1 and of image 2
};

}  // namespace rcme
