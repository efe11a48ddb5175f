#pragma once

#include <Eigen/Core>

namespace rcme {

// Ideal pinhole camera (assumption a.1: calibrated, no distortion). Looks along +z, x to the right, y down.
struct Camera {
  double fx = 0.0, fy = 0.0;  // focal lengths, px
  double cx = 0.0, cy = 0.0;  // principal point, px
  int width = 0, height = 0;  // image size, px

  // 3x3 intrinsic matrix K.
  Eigen::Matrix3d K() const;
  Eigen::Matrix3d InverseK() const;

  // The viewing ray K^-1 [x_px; 1], with third component 1.
  Eigen::Vector3d Ray(const Eigen::Vector2d& x_px) const {
    return {(x_px.x() - cx) / fx, (x_px.y() - cy) / fy, 1.0};
  }

  // Pixel of a point in the camera's frame; the point's depth must not be zero.
  Eigen::Vector2d Project(const Eigen::Vector3d& point_in_cam) const {
    return {fx * point_in_cam.x() / point_in_cam.z() + cx, fy * point_in_cam.y() / point_in_cam.z() + cy};
  }

  // Whether the pixel lies in the image, whose border runs half a pixel outside the outermost pixel centres.
  bool IsInImage(const Eigen::Vector2d& x_px) const {
    return x_px.x() >= -0.5 && x_px.x() <= width - 0.5 && x_px.y() >= -0.5 && x_px.y() <= height - 0.5;
  }

  // K is finite and invertible and the image is not empty.
  bool IsValid() const;
};

}  // namespace rcme
