#include "simulator/camera_defects.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parameters/input_error.h"
#include "simulator/exact_match.h"
#include "stats/constants.h"

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

// The camera at a time: X(time) = R X1 + T.
struct CameraAtTime {
  CameraAtTime(const ViewPair& view, double time)
      : R(RotationFromVector(time * VectorFromRotation(view.cam2_from_cam1_true.R))),
        T(time * (view.baseline_m * view.cam2_from_cam1_true.t)) {}
  Eigen::Matrix3d R;
  Eigen::Vector3d T;
};

// When a row is read, after the middle row of its image.
double TimeOfRow(const SceneCamera& camera, const CameraDefects& defects, double row_px) {
  return defects.rolling_shutter * ((row_px + 0.5) / camera.height - 0.5);
}

// The pixel of a point in the image whose middle row is read at the time `middle`.
Eigen::Vector2d ImagedPoint(const ViewPair& view, const SceneCamera& camera, double middle,
                            const CameraDefects& defects, const Eigen::Vector3d& point_in_cam1) {
  const auto imaged_at = [&](double time) {
    const CameraAtTime at(view, time);
    return ProjectDistorted(camera, defects.distortion_k1, at.R * point_in_cam1 + at.T);
  };
  Eigen::Vector2d x_px = imaged_at(middle);
  if (defects.rolling_shutter == 0.0) return x_px;
  for (int round = 0; round < kRounds; ++round) {
    x_px = imaged_at(middle + TimeOfRow(camera, defects, x_px.y()));
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

Eigen::Vector3d PointOnSameRay(const ViewPair& view, const CameraDefects& defects,
                               const Eigen::Vector3d& point_in_cam1, const Eigen::Vector2d& x1_px,
                               double distance_m) {
  const CameraAtTime at(view, TimeOfRow(view.camera1, defects, x1_px.y()));
  const Eigen::Vector3d ray = (at.R * point_in_cam1 + at.T).normalized();
  return at.R.transpose() * (distance_m * ray - at.T);
}

void CheckDistortion(const ViewPair& view, const CameraDefects& defects) {
  if (defects.distortion_k1 >= 0.0) return;
  for (const SceneCamera* camera : {&view.camera1, &view.camera2}) {
    double farthest = 0.0;  // tangent of a corner's angle from the axis
    for (const double x : {-0.5, camera->width - 0.5}) {
      for (const double y : {-0.5, camera->height - 0.5}) {
        const Eigen::Vector3d ray =
            camera->Ray({x, y});  // not finite: the corner is outside of the circle of a fisheye lens
        farthest = std::max(farthest,
                            ray.allFinite() ? ray.head<2>().norm() : std::numeric_limits<double>::infinity());
      }
    }
    // r (1 + k1 r^2) grows up to 1 + 3 k1 r^2 = 0.
    const double least = -1.0 / (3.0 * farthest * farthest);
    if (defects.distortion_k1 > least) continue;
    throw InputError(fmt::format(
        "distortion_k1: {:g} folds an image whose corners are {:.0f} deg from the axis; allowed above {:.4g}, or give a "
        "longer focal length or a smaller image",
        defects.distortion_k1, std::atan(farthest) * kDegPerRad, least));
  }
}

}  // namespace rcme
