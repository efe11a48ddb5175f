#include "simulator/camera_defects.h"

#include <gtest/gtest.h>

#include "simulator/exact_match.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

ViewPair ViewWithTranslation(const Eigen::Vector3d& T) {
  ViewPair view;
  view.camera1 = view.camera2 = Camera{500.0, 400.0, 319.5, 239.5, 640, 480};
  view.cam2_from_cam1_true.t = T.normalized();
  view.baseline_m = T.norm();
  return view;
}

TEST(CameraDefects, WithoutThemTheImageIsThatOfAPinhole) {
  const Scene scene = TwoCameraScene(20, 1);
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    EXPECT_EQ(ImagedMatch(scene, {}, point).x1_px, ExactMatch(scene, point).x1_px);
    EXPECT_EQ(ImagedMatch(scene, {}, point).x2_px, ExactMatch(scene, point).x2_px);
  }
}

// The ray (0.3, -0.4, 1): r^2 = 0.25, so that 0.1 moves it by 1.025. In camera 2 it is (0.4, -0.4, 1), r^2 =
// 0.32.
TEST(CameraDefects, DistortionByHand) {
  const ViewPair view = ViewWithTranslation({0.2, 0.0, 0.0});
  const Correspondence match = ImagedMatch(view, {.distortion_k1 = 0.1}, {0.6, -0.8, 2.0});
  EXPECT_NEAR(match.x1_px.x(), 319.5 + 1.025 * 0.3 * 500.0, 1e-9);
  EXPECT_NEAR(match.x1_px.y(), 239.5 - 1.025 * 0.4 * 400.0, 1e-9);
  EXPECT_NEAR(match.x2_px.x(), 319.5 + 1.032 * 0.4 * 500.0, 1e-9);
  EXPECT_NEAR(match.x2_px.y(), 239.5 - 1.032 * 0.4 * 400.0, 1e-9);
}

// A camera that moves sideways keeps the row v of a point: it is read at a = s ((v + 1/2) / 480 - 1/2).
TEST(CameraDefects, RollingShutterOfASidewaysMotion) {
  const ViewPair view = ViewWithTranslation({0.2, 0.0, 0.0});
  const Eigen::Vector3d point(0.6, -0.8, 2.0);
  const double v = 239.5 - 0.4 * 400.0, a = 0.1 * ((v + 0.5) / 480.0 - 0.5);
  const Correspondence match = ImagedMatch(view, {.rolling_shutter = 0.1}, point);
  EXPECT_NEAR(match.x1_px.y(), v, 1e-9);
  EXPECT_NEAR(match.x2_px.y(), v, 1e-9);
  EXPECT_NEAR(match.x1_px.x(), 319.5 + 500.0 * (0.6 + a * 0.2) / 2.0, 1e-9);
  EXPECT_NEAR(match.x2_px.x(), 319.5 + 500.0 * (0.6 + (1.0 + a) * 0.2) / 2.0, 1e-9);
  // The middle row is read in the middle, where the true motion is that of a pinhole.
  const Eigen::Vector3d of_middle_row(0.3, 0.0, 2.0);
  EXPECT_NEAR((ImagedMatch(view, {.rolling_shutter = 0.1}, of_middle_row).x2_px -
               ExactMatch(view, of_middle_row).x2_px)
                  .norm(),
              0.0, 1e-9);
}

// A downward motion moves the row while it is awaited: v = v0 + f T a / Z, a linear in v, has the solution
// below.
TEST(CameraDefects, RollingShutterFindsTheRowOfAPointThatMovesDown) {
  const ViewPair view = ViewWithTranslation({0.0, 0.3, 0.0});
  const double v0 = 239.5 + 400.0 * 0.5 / 2.0, speed = 400.0 * 0.3 / 2.0, share = 0.2;
  const double v = (v0 + speed * share * (0.5 / 480.0 - 0.5)) / (1.0 - speed * share / 480.0);
  const Correspondence match = ImagedMatch(view, {.rolling_shutter = share}, {0.1, 0.5, 2.0});
  EXPECT_NEAR(match.x1_px.y(), v, 1e-7);
}

// A point on the axis about which the camera turns stays; elsewhere the turn of the time at which its row is
// read.
TEST(CameraDefects, RollingShutterTurnsWithTheMotion) {
  ViewPair view = ViewWithTranslation({1.0, 0.0, 0.0});
  view.baseline_m = 0.0;
  const Eigen::Vector3d w(0.02, -0.05, 0.1), point(0.4, -0.3, 2.0);
  view.cam2_from_cam1_true.R = RotationFromVector(w);
  const Correspondence match = ImagedMatch(view, {.rolling_shutter = 0.3}, point);
  for (const auto& [x_px, middle] : {std::pair{match.x1_px, 0.0}, {match.x2_px, 1.0}}) {
    const double a = middle + 0.3 * ((x_px.y() + 0.5) / 480.0 - 0.5);
    const Eigen::Vector2d expected = view.camera1.Project(RotationFromVector(a * w) * point);
    EXPECT_NEAR((x_px - expected).norm(), 0.0, 1e-6);
    EXPECT_GT((x_px - view.camera1.Project(RotationFromVector(middle * w) * point)).norm(), 0.5);
  }
}

// Points of one ray of camera 1 at any distance keep their pixel of image 1, at the row's time; the given
// point is one of them.
TEST(CameraDefects, PointsOnTheSameRayShareTheirPixel) {
  ViewPair view = ViewWithTranslation({0.2, -0.1, 0.3});
  view.cam2_from_cam1_true.R = RotationFromVector({0.02, -0.05, 0.1});
  const Eigen::Vector3d point(0.4, -0.6, 2.0);
  for (const CameraDefects& defects :
       {CameraDefects{.rolling_shutter = 0.2}, {.distortion_k1 = 0.05, .rolling_shutter = -0.1}}) {
    const Eigen::Vector2d x1_px = ImagedMatch(view, defects, point).x1_px;
    double nearest_m = 1.0;
    for (const double distance_m : {0.5, 1.0, 2.1, 2.1284, 3.0, 50.0}) {
      const Eigen::Vector3d other = PointOnSameRay(view, defects, point, x1_px, distance_m);
      EXPECT_NEAR((ImagedMatch(view, defects, other).x1_px - x1_px).norm(), 0.0, 1e-6);
      nearest_m = std::min(nearest_m, (other - point).norm());
    }
    EXPECT_LT(nearest_m, 0.06);
    EXPECT_GT((ImagedMatch(view, defects, 0.25 * point).x1_px - x1_px).norm(),
              0.1);  // on the ray of the middle row
  }
}

// r = sqrt(.64^2 + .6^2) = .8773 at the corners, half a pixel beyond the outermost centres: folded from -1 /
// (3 r^2) = -.4331 on.
TEST(CameraDefects, ADistortionThatFoldsAnImageIsRefused) {
  const ViewPair view = ViewWithTranslation({0.2, 0.0, 0.0});
  EXPECT_NO_THROW(CheckDistortion(view, {.distortion_k1 = 0.5}));
  EXPECT_NO_THROW(CheckDistortion(view, {.distortion_k1 = -0.433}));
  EXPECT_TRUE(ThrowsInputError([&] { CheckDistortion(view, {.distortion_k1 = -0.434}); },
                               {"distortion_k1: -0.434", "41 deg", "-0.4331", "focal length"}));
}

}  // namespace
}  // namespace rcme
