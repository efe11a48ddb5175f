#include "experiments/real/truth_free/camera_faults.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "estimator/geometry/triangulation.h"

namespace rcme {
namespace {

constexpr double kLeastDepth = 1e-6;  // in camera 2, of a depth of one in camera 1

// Velocity of a point's image, px per unit of time of `velocity`.
Eigen::Vector2d ImageVelocity(const Camera& camera, const Eigen::Vector3d& point,
                              const Eigen::Vector3d& velocity) {
  const Eigen::Vector2d ray = point.head<2>() / point.z();
  const Eigen::Vector2d rate = (velocity.head<2>() - ray * velocity.z()) / point.z();
  return {camera.fx * rate.x(), camera.fy * rate.y()};
}

double FindImageRow(const Camera& camera, const Eigen::Vector2d& x_px) {
  return (x_px.y() + 0.5) / camera.height - 0.5;
}

// Shift of both key points for a readout that takes the whole time between the images. Lengths are in units
// of the point's depth in camera 1.
Eigen::Vector4d ShiftByReadout(const Camera& camera1, const Camera& camera2, const RelativePose& pose,
                               const Correspondence& match) {
  const Eigen::Vector3d ray1 = camera1.Ray(match.x1_px), w = VectorFromRotation(pose.R);
  const Eigen::Vector3d t = std::max(0.0, InverseDepth(pose, ray1, camera2.Ray(match.x2_px))) * pose.t;
  const Eigen::Vector3d turned = pose.R * ray1;
  Eigen::Vector4d shift = Eigen::Vector4d::Zero();
  if (!(turned.z() + t.z() > kLeastDepth)) return shift;
  shift << FindImageRow(camera1, match.x1_px) * ImageVelocity(camera1, ray1, w.cross(ray1) + t),
      FindImageRow(camera2, match.x2_px) * ImageVelocity(camera2, turned + t, w.cross(turned) + t);
  return shift;
}

double At(const FaultVector& faults, CameraFault fault) { return faults(static_cast<Eigen::Index>(fault)); }

Eigen::Vector2d ShiftOfImage2(const FaultVector& faults) {
  return {At(faults, CameraFault::kImage2ShiftX), At(faults, CameraFault::kImage2ShiftY)};
}

// Puts the faults of the intrinsics in (sign 1) or takes them out (-1).
void ChangeIntrinsics(const FaultVector& faults, double sign, Camera* camera) {
  const double focal = std::pow(1.0 + At(faults, CameraFault::kFocalLength), sign);
  camera->fx *= focal;
  camera->fy *= focal;
  camera->cx += sign * At(faults, CameraFault::kPrincipalPointX);
  camera->cy += sign * At(faults, CameraFault::kPrincipalPointY);
}

Eigen::Vector2d Distort(const Camera& camera, double k1, const Eigen::Vector2d& x_px) {
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  return centre + (1.0 + k1 * camera.Ray(x_px).head<2>().squaredNorm()) * (x_px - centre);
}

// Each round reduces the error by the factor 2 |k1| |ray|^2, usually a fifth or less.
Eigen::Vector2d Undistort(const Camera& camera, double k1, const Eigen::Vector2d& x_px) {
  constexpr int kRounds = 20;
  const Eigen::Vector2d centre(camera.cx, camera.cy);
  Eigen::Vector2d undistorted = x_px;
  for (int round = 0; round < kRounds && k1 != 0.0; ++round) {
    const double stretch = 1.0 + k1 * camera.Ray(undistorted).head<2>().squaredNorm();
    if (!(stretch > 0.1)) return x_px;  // the lens folds here
    undistorted = centre + (x_px - centre) / stretch;
  }
  return undistorted;
}

}  // namespace

const CameraFaultText& FindFaultText(CameraFault fault) {
  static constexpr std::array<CameraFaultText, kNumCameraFaults> kTexts = {{
      {"focal_length", "focal length", "%", 100.0, 0.002, "too long", "too short"},
      {"principal_point_x", "principal point, x", "px", 1.0, 1.0, "too far right", "too far left"},
      {"principal_point_y", "principal point, y", "px", 1.0, 1.0, "too far down", "too far up"},
      {"distortion", "distortion k1", "", 1.0, 0.001, "left in the images, pincushion",
       "left in the images, barrel"},
      {"readout_time", "readout time", "%", 100.0, 0.01, "of the time between the images: a rolling shutter",
       "of the time between the images: a rolling shutter, upwards"},
      {"image2_shift_x", "key points of image 2, x", "px", 1.0, 0.1, "too far right", "too far left"},
      {"image2_shift_y", "key points of image 2, y", "px", 1.0, 0.1, "too far down", "too far up"},
      {"aspect_ratio", "aspect ratio of pixels", "%", 100.0, 0.002, "too high", "too low"},
      {"distortion_k2", "distortion k2", "", 1.0, 0.001, "pincushion", "barrel"},
      {"tangential_x", "tangential distortion, x", "", 1.0, 0.001, "right", "left"},
      {"tangential_y", "tangential distortion, y", "", 1.0, 0.001, "down", "up"},
  }};
  return kTexts[static_cast<size_t>(fault)];
}

ShiftsByFaults ComputeShifts(const Camera& camera1, const Camera& camera2, const RelativePose& cam2_from_cam1,
                             const Correspondence& match) {
  ShiftsByFaults shifts = ShiftsByFaults::Zero();
  const auto fill = [&](Eigen::Index row, const Camera& camera, const Eigen::Vector2d& x_px) {
    const Eigen::Vector2d from_centre = x_px - Eigen::Vector2d(camera.cx, camera.cy);
    shifts.block<2, 1>(row, 0) = -from_centre;
    shifts.block<2, 2>(row, 1) = -Eigen::Matrix2d::Identity();
    const Eigen::Vector2d ray = camera.Ray(x_px).head<2>();
    const double r2 = ray.squaredNorm(), rx_ry = ray.x() * ray.y();
    shifts.block<2, 1>(row, 3) = r2 * from_centre;
    shifts.block<2, 1>(row, 7) << 0.0, -from_centre.y();
    shifts.block<2, 1>(row, 8) = r2 * r2 * from_centre;
    shifts.block<2, 1>(row, 9) << camera.fx * (r2 + 2.0 * ray.x() * ray.x()), 2.0 * camera.fy * rx_ry;
    shifts.block<2, 1>(row, 10) << 2.0 * camera.fx * rx_ry, camera.fy * (r2 + 2.0 * ray.y() * ray.y());
  };
  fill(0, camera1, match.x1_px);
  fill(2, camera2, match.x2_px);
  shifts.col(4) = ShiftByReadout(camera1, camera2, cam2_from_cam1, match);
  shifts.block<2, 2>(2, 5) = Eigen::Matrix2d::Identity();
  return shifts;
}

double GreatestFault(CameraFault fault, const Camera& camera) {
  switch (fault) {
    case CameraFault::kPrincipalPointX:
      return 0.25 * camera.width;
    case CameraFault::kPrincipalPointY:
      return 0.25 * camera.height;
    case CameraFault::kReadoutTime:
      return 1.0;
    case CameraFault::kImage2ShiftX:
    case CameraFault::kImage2ShiftY:
      return 10.0;
    default:
      return 0.5;
  }
}

MotionProblem RemoveFaults(MotionProblem problem, const RelativePose& cam2_from_cam1,
                           const FaultVector& faults) {
  for (Camera* camera : {&problem.camera1, &problem.camera2}) ChangeIntrinsics(faults, -1.0, camera);
  for (Correspondence& match : problem.matches) {
    match.x2_px -= ShiftOfImage2(faults);
    const Eigen::Vector4d by_readout =
        At(faults, CameraFault::kReadoutTime) *
        ShiftByReadout(problem.camera1, problem.camera2, cam2_from_cam1, match);
    match.x1_px = Undistort(problem.camera1, At(faults, CameraFault::kDistortion), match.x1_px);
    match.x2_px = Undistort(problem.camera2, At(faults, CameraFault::kDistortion), match.x2_px);
    match.x1_px -= by_readout.head<2>();
    match.x2_px -= by_readout.tail<2>();
  }
  return problem;
}

MotionProblem PlantFaults(MotionProblem problem, const FaultVector& faults) {
  for (Correspondence& match : problem.matches) {
    match.x1_px = Distort(problem.camera1, At(faults, CameraFault::kDistortion), match.x1_px);
    match.x2_px = Distort(problem.camera2, At(faults, CameraFault::kDistortion), match.x2_px);
    match.x2_px += ShiftOfImage2(faults);
  }
  for (Camera* camera : {&problem.camera1, &problem.camera2}) ChangeIntrinsics(faults, 1.0, camera);
  return problem;
}

}  // namespace rcme
