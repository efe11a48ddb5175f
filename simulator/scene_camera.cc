#include "simulator/scene_camera.h"

#include <limits>

namespace rcme {

Eigen::Vector3d SceneCamera::RayThroughLens(const Eigen::Vector2d& x_px) const {
  const std::optional<Eigen::Vector2d> ideal_px = Undistort(AsLens(), x_px);
  if (!ideal_px) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  return Camera::Ray(*ideal_px);
}

}  // namespace rcme
