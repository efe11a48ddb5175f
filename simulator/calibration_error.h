#pragma once

#include <limits>
#include <vector>

#include "estimator/geometry/camera.h"
#include "parameters/parameter.h"

namespace rcme {

// Assumptions of the estimators that differ from the truth.
struct CalibrationError {
  double assumed_sigma_px = std::numeric_limits<double>::quiet_NaN();  // NaN: the true one
  double focal_error = 0.0;               // relative: assumed f = true f (1 + error), both cameras
  double principal_point_error_px = 0.0;  // assumed cx, cy = true ones + error, both cameras

  double AssumedSigma(double sigma_true_px) const;
  Camera AssumedCamera(Camera camera_true) const;
};
std::vector<Parameter> Parameters(CalibrationError& error);

}  // namespace rcme
