#include "simulator/calibration_error.h"

#include <cmath>

namespace rcme {

double CalibrationError::AssumedSigma(double sigma_true_px) const {
  return std::isnan(assumed_sigma_px) ? sigma_true_px : assumed_sigma_px;
}

Camera CalibrationError::AssumedCamera(Camera camera_true) const {
  camera_true.fx *= 1.0 + focal_error;
  camera_true.fy *= 1.0 + focal_error;
  camera_true.cx += principal_point_error_px;
  camera_true.cy += principal_point_error_px;
  return camera_true;
}

std::vector<Parameter> Parameters(CalibrationError& error) {
  return {Parameter::RealOrWord("assumed_sigma_px", &error.assumed_sigma_px, {1e-9, 1000.0}, "true", "px",
                                "noise that the estimators assume"),
          Parameter::Real("focal_error", &error.focal_error, {-0.9, 9.0}, "",
                          "relative error of the assumed focal lengths"),
          Parameter::Real("principal_point_error_px", &error.principal_point_error_px, {-1e5, 1e5}, "px",
                          "error of the assumed principal points in x and y")};
}

}  // namespace rcme
