#pragma once

#include <vector>

#include "estimator/geometry/camera.h"
#include "parameters/parameter.h"

namespace rcme {

// Two equal pinhole cameras, principal point in the middle of the image.
struct CameraPair {
  int image_width = 640, image_height = 480;  // px
  double focal_px = 700.0;

  Camera Make() const;
};
std::vector<Parameter> Parameters(CameraPair& cameras);

}  // namespace rcme
