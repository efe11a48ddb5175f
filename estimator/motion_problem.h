#pragma once

#include <vector>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"

namespace rcme {

// All that an estimator may know: the matches, the cameras, and the noise level it is told.
struct MotionProblem {
  std::vector<Correspondence> matches;
  Camera camera1, camera2;
  double sigma_px = 0.5;  // standard deviation of the noise per coordinate in each image (a.2)
};

}  // namespace rcme
