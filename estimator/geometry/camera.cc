#include "estimator/geometry/camera.h"

#include <cmath>

namespace rcme {

Eigen::Matrix3d Camera::K() const {
  Eigen::Matrix3d matrix;
  matrix << fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0;
  return matrix;
}

Eigen::Matrix3d Camera::InverseK() const {
  Eigen::Matrix3d matrix;
  matrix << 1.0 / fx, 0.0, -cx / fx, 0.0, 1.0 / fy, -cy / fy, 0.0, 0.0, 1.0;
  return matrix;
}

bool Camera::IsValid() const {
  return std::isfinite(fx) && std::isfinite(fy) && std::isfinite(cx) && std::isfinite(cy) && fx > 0.0 &&
         fy > 0.0 && width > 0 && height > 0;
}

}  // namespace rcme
