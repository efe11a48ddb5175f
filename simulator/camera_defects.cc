#include "simulator/camera_defects.h"

#include "simulator/exact_match.h"

namespace rcme {
namespace {

// The row of a point determines its time, which in turn moves the row. Each round reduces the error by the
// share of the image that a point moves meanwhile, a tenth or less.
constexpr int kRounds = 8;

Eigen::Vector2d ProjectDistorted(const SceneCamera& camera, double k1, const Eigen::Vector3d& point_in_cam) {
  if (camera.HasLens()) {  // the residual distortion acts on the rays before the lens
    const double r2 = point_in_cam.head<2>().squaredNorm() / (point_in_cam.z() * point_in_cam.z());
    const Eigen::Vector2d bent = (1.0 + k1 * r2) * point_in_cam.head<2>();
    return camera.Project({bent.x(), bent.y(), point_in_cam.z()});
  }
  const Eigen::Vector2d x_px = camera.Project(point_in_cam), centre_px(camera.cx, camera.cy);
  const Eigen::Vector2d ray = camera.Ray(x_px).head<2>();
  return centre_px + (1.0 + k1 * ray.squaredNorm()) * (x_px - centre_px);
}

// The pixel of a point in the image whose middle row is read at the time `middle`.
Eigen::Vector2d ImagedPoint(const ViewPair& view, const SceneCamera& camera, double middle,
                            const CameraDefects& defects, const Eigen::Vector3d& point_in_cam1) {
  const Eigen::Vector3d w = VectorFromRotation(view.cam2_from_cam1_true.R);
  const Eigen::Vector3d T = view.baseline_m * view.cam2_from_cam1_true.t;
  const auto imaged_at = [&](double time) {
    const Eigen::Vector3d point = RotationFromVector(time * w) * point_in_cam1 + time * T;
    return ProjectDistorted(camera, defects.distortion_k1, point);
  };
  Eigen::Vector2d x_px = imaged_at(middle);
  if (defects.rolling_shutter == 0.0) return x_px;
  for (int round = 0; round < kRounds; ++round) {
    const double row = (x_px.y() + 0.5) / camera.height - 0.5;
    x_px = imaged_at(middle + defects.rolling_shutter * row);
  }
  return x_px;
}

}  // namespace

std::vector<Parameter> Parameters(CameraDefects& defects) {
  return {Parameter::Real("distortion_k1", &defects.distortion_k1, {-0.5, 0.5}, "",
                          "radial distortion of both images, unknown to estimators"),
          Parameter::Real("rolling_shutter", &defects.rolling_shutter, {-0.5, 0.5}, "",
                          "readout time over the time between the images; negative: upwards")};
}

Correspondence ImagedMatch(const ViewPair& view, const CameraDefects& defects,
                           const Eigen::Vector3d& point_in_cam1) {
  if (defects.IsNone()) return ExactMatch(view, point_in_cam1);
  return {ImagedPoint(view, view.camera1, 0.0, defects, point_in_cam1),
          ImagedPoint(view, view.camera2, 1.0, defects, point_in_cam1)};
}

}  // namespace rcme
