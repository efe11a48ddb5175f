#pragma once

#include "estimator/geometry/camera.h"
#include "estimator/geometry/lens.h"

namespace rcme {

// A camera of the simulator, possibly with a lens. Its pixels and its size are those of the distorted image.
// Its base Camera is the pinhole camera with the same K, to which undistortion leads.
struct SceneCamera : Camera {
  SceneCamera() = default;
  SceneCamera(const Camera& pinhole) : Camera(pinhole) {}  // implicit: without a lens
  explicit SceneCamera(const Lens& lens) : Camera(lens.camera), model(lens.model), k(lens.k) {}

  LensModel model = LensModel::kPinhole;
  std::array<double, 8> k{};  // as Lens::k

  bool HasLens() const { return model != LensModel::kPinhole; }
  Lens AsLens() const { return {*this, model, k}; }

  // Pixel of a point in the camera's frame; the depth must not be zero. With a lens it is defined only for
  // points that the image Shows().
  Eigen::Vector2d Project(const Eigen::Vector3d& point_in_cam) const {
    return HasLens() ? ProjectThrough(AsLens(), Normalize(point_in_cam)) : Camera::Project(point_in_cam);
  }
  // The viewing ray of a pixel, with third component 1; NaN if no ray reaches the pixel.
  Eigen::Vector3d Ray(const Eigen::Vector2d& x_px) const {
    return HasLens() ? RayThroughLens(x_px) : Camera::Ray(x_px);
  }
  // Whether the pixel lies in the image and a ray reaches it.
  bool IsInImage(const Eigen::Vector2d& x_px) const {
    return Camera::IsInImage(x_px) && (!HasLens() || Undistort(AsLens(), x_px).has_value());
  }
  // Whether the image shows the point.
  bool Shows(const Eigen::Vector3d& point_in_cam) const {
    return point_in_cam.z() > 0.0 && Camera::IsInImage(Project(point_in_cam)) &&
           (!HasLens() || IsImaged(AsLens(), Normalize(point_in_cam)));
  }
  // d pixel / d ray (2x2, px) at the ray (x, y, 1).
  Eigen::Matrix2d RayJacobian(const Eigen::Vector2d& ray) const {
    return ProjectThroughJacobian(AsLens(), ray);
  }

 private:
  static Eigen::Vector2d Normalize(const Eigen::Vector3d& point_in_cam) {
    return point_in_cam.head<2>() / point_in_cam.z();
  }
  Eigen::Vector3d RayThroughLens(const Eigen::Vector2d& x_px) const;
};

}  // namespace rcme
