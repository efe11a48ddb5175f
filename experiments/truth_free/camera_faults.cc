#include "experiments/truth_free/camera_faults.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "estimator/geometry/triangulation.h"

namespace rcme {
namespace {

constexpr double kLeastDepth = 1e-6;  // in camera 2, of a depth of one in camera 1

// Per pixel of the image, of a point's velocity.
Eigen::Vector2d ImageVelocity(const Camera& camera, const Eigen::Vector3d& point,
                              const Eigen::Vector3d& velocity) {
  const Eigen::Vector2d ray = point.head<2>() / point.z();
  const Eigen::Vector2d rate = (velocity.head<2>() - ray * velocity.z()) / point.z();
  return {camera.fx * rate.x(), camera.fy * rate.y()};
}

double RowOf(const Camera& camera, const Eigen::Vector2d& x_px) {
  return (x_px.y() + 0.5) / camera.height - 0.5;
}

// All in units of the point's depth in camera 1.
Eigen::Vector4d ShiftByReadout(const Camera& camera1, const Camera& camera2, const RelativePose& pose,
                               const Correspondence& match) {
  const Eigen::Vector3d ray1 = camera1.Ray(match.x1_px), w = VectorFromRotation(pose.R);
  const Eigen::Vector3d t = std::max(0.0, InverseDepth(pose, ray1, camera2.Ray(match.x2_px))) * pose.t;
  const Eigen::Vector3d turned = pose.R * ray1;
  Eigen::Vector4d shift = Eigen::Vector4d::Zero();
  if (!(turned.z() + t.z() > kLeastDepth)) return shift;
  shift << RowOf(camera1, match.x1_px) * ImageVelocity(camera1, ray1, w.cross(ray1) + t),
      RowOf(camera2, match.x2_px) * ImageVelocity(camera2, turned + t, w.cross(turned) + t);
  return shift;
}

}  // namespace

const CameraFaultText& TextOf(CameraFault fault) {
  static constexpr std::array<CameraFaultText, kNumCameraFaults> kTexts = {{
      {"focal_length", "focal length", "%", 100.0, 0.002, "too long", "too short"},
      {"principal_point_x", "principal point, x", "px", 1.0, 1.0, "too far right", "too far left"},
      {"principal_point_y", "principal point, y", "px", 1.0, 1.0, "too far down", "too far up"},
      {"distortion", "distortion k1", "", 1.0, 0.001, "left in the images, pincushion",
       "left in the images, barrel"},
      {"readout_time", "readout time", "%", 100.0, 0.01, "of the time between the images: a rolling shutter",
       "of the time between the images: a rolling shutter, upwards"},
  }};
  return kTexts[static_cast<size_t>(fault)];
}

ShiftsByFaults ShiftsOf(const Camera& camera1, const Camera& camera2, const RelativePose& cam2_from_cam1,
                        const Correspondence& match) {
  ShiftsByFaults shifts = ShiftsByFaults::Zero();
  const auto fill = [&](Eigen::Index row, const Camera& camera, const Eigen::Vector2d& x_px) {
    const Eigen::Vector2d from_centre = x_px - Eigen::Vector2d(camera.cx, camera.cy);
    shifts.block<2, 1>(row, 0) = -from_centre;
    shifts.block<2, 2>(row, 1) = -Eigen::Matrix2d::Identity();
    shifts.block<2, 1>(row, 3) = camera.Ray(x_px).head<2>().squaredNorm() * from_centre;
  };
  fill(0, camera1, match.x1_px);
  fill(2, camera2, match.x2_px);
  shifts.col(4) = ShiftByReadout(camera1, camera2, cam2_from_cam1, match);
  return shifts;
}

}  // namespace rcme
