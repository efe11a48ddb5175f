// Cameras with lenses: what they show, and that scenes, wrong matches and severity are those of their images.
#include "simulator/scene_camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "parameters/input_error.h"
#include "simulator/camera_registry.h"
#include "simulator/exact_match.h"
#include "simulator/outlier_registry.h"
#include "simulator/scene_generator.h"
#include "simulator/scenes/view_volume.h"
#include "simulator/severity/point_information.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"

namespace rcme {
namespace {

constexpr const char* kLensNames[] = {"radtan", "fisheye"};

SceneCamera MakeCamera(const std::string& name, const Settings& settings = {}) {
  const auto model = FindEntry(CameraRegistry(), "cameras", name).make();
  for (const auto& [key, value] : settings) FindParameter(model->Parameters(), key).SetFromText(value);
  return model->Make().first;
}

TEST(SceneCamera, WithoutALensIsThePinhole) {
  const Camera pinhole{500.0, 510.0, 320.0, 240.0, 640, 480};
  const SceneCamera camera = pinhole;
  const Eigen::Vector3d seen(0.3, -0.2, 1.7), outside(3.0, 0.0, 1.0);
  EXPECT_EQ(camera.Project(seen), pinhole.Project(seen));
  EXPECT_EQ(camera.Ray({7.0, 9.0}), pinhole.Ray({7.0, 9.0}));
  EXPECT_TRUE(camera.Shows(seen));
  EXPECT_FALSE(camera.Shows(outside));
  EXPECT_FALSE(camera.Shows(-seen));
}

TEST(SceneCamera, RaysAreThoseOfItsPixels) {
  for (const char* name : kLensNames) {
    const SceneCamera camera = MakeCamera(name);
    for (const Eigen::Vector3d& point : {Eigen::Vector3d(0.3, -0.2, 1.0), Eigen::Vector3d(-1.0, 0.7, 2.0)}) {
      EXPECT_LT((camera.Ray(camera.Project(point)) - point / point.z()).norm(), 1e-12) << name;
      EXPECT_GT((camera.Project(point) - camera.Camera::Project(point)).norm(), 0.5) << name;
    }
  }
}

// r (1 - .5 r^2): rays up to r = .816 reach up to .544 focal lengths, those beyond come back.
TEST(SceneCamera, ShowsNothingBehindTheFold) {
  const SceneCamera camera = MakeCamera(
      "radtan",
      {{"focal_px", "300"}, {"lens_k1", "-0.5"}, {"lens_k2", "0"}, {"lens_p1", "0"}, {"lens_p2", "0"}});
  EXPECT_TRUE(camera.Shows({0.0, 0.81, 1.0}));
  EXPECT_FALSE(camera.Shows({0.0, 0.83, 1.0}));
  EXPECT_TRUE(static_cast<const Camera&>(camera).IsInImage(camera.Project({0.0, 0.83, 1.0})));
  const Eigen::Vector2d centre_px(camera.cx, camera.cy);
  EXPECT_TRUE(camera.IsInImage(centre_px + Eigen::Vector2d(0.0, 163.0)));
  EXPECT_FALSE(camera.IsInImage(centre_px + Eigen::Vector2d(0.0, 164.0)));
  EXPECT_TRUE(std::isnan(camera.Ray(centre_px + Eigen::Vector2d(0.0, 164.0)).x()));
}

TEST(SceneCamera, ALensThatShowsNextToNothingIsRefused) {
  const SceneCamera camera = MakeCamera("fisheye", {{"focal_px", "1"}, {"image_width", "100000"}});
  RandomStream rng({.seed = 1});
  try {
    DrawRay(camera, rng);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("focal_px"), std::string::npos) << error.what();
  }
}

Scene LensScene(const std::string& cameras, std::uint32_t trial, int num_matches = 100) {
  SceneGenerator generator("uniform_volume", cameras, "general");
  for (const auto& [key, value] : Settings{{"num_matches", std::to_string(num_matches)},
                                           {"parallax_deg", "none"},
                                           {"baseline_m", "0.5"},
                                           {"max_rotation_deg", "10"}}) {
    FindParameter(generator.Parameters(), key).SetFromText(value);
  }
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 83});
  Scene scene = generator.Generate(rng);
  scene.repeat_steps_m = {{0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}};
  return scene;
}

// A fisheye shows points far beyond what a pinhole of its focal length and size would.
TEST(SceneCamera, PointsFillTheImageAsItIsTaken) {
  const Scene scene = LensScene("fisheye", 0, 4000);
  int num_wide = 0;
  double greatest = 0.0;
  for (const Eigen::Vector3d& point : scene.points_in_cam1) {
    ASSERT_TRUE(scene.Sees(point));
    num_wide += !static_cast<const Camera&>(scene.camera1).IsInImage(scene.camera1.Camera::Project(point));
    greatest = std::max(greatest, point.head<2>().norm() / point.z());
  }
  EXPECT_GT(num_wide, 800);  // that a pinhole of this size would not show
  EXPECT_GT(greatest, 3.0);
}

TEST(SceneCamera, WrongMatchesLieInTheImagesAndOnRays) {
  for (const char* name : kLensNames) {
    for (const OutlierEntry& law : OutlierRegistry()) {
      SCOPED_TRACE(std::string(name) + " " + law.name);
      for (std::uint32_t trial = 0; trial < 5; ++trial) {
        const Scene scene = LensScene(name, trial);
        const DrawnOutliers wrong = MakeWrong(*law.make(), scene, 60, 0.0, trial);
        for (size_t i = 0; i < 100; ++i) {
          ASSERT_TRUE(scene.camera1.IsInImage(wrong.matches[i].x1_px));
          ASSERT_TRUE(scene.camera2.IsInImage(wrong.matches[i].x2_px));
          const bool is_on_curve = std::abs(TripleProduct(scene, wrong.matches[i])) < 1e-10;
          EXPECT_EQ(wrong.is_undetectable[i], i < 60 && is_on_curve);
          EXPECT_EQ(wrong.is_undetectable[i], i < 60 && law.name == "epipolar");
        }
      }
    }
  }
}

// At least outlier_min_shift_px (5) from the true point, as without a lens.
TEST(SceneCamera, WrongMatchesOnTheEpipolarCurveAreShifted) {
  const Scene scene = LensScene("fisheye", 1);
  const auto law = FindEntry(OutlierRegistry(), "outliers", "epipolar").make();
  const DrawnOutliers wrong = MakeWrong(*law, scene, 60);
  for (size_t i = 0; i < 60; ++i)
    EXPECT_GE((wrong.matches[i].x2_px - wrong.exact[i].x2_px).norm(),
              wrong.matches[i].x1_px == wrong.exact[i].x1_px ? 5.0 : 0.0);
}

// The pixels of a point as the motion and the point move (severity/point_information.h), by differences.
TEST(SceneCamera, TheInformationOfAPointIsThatOfItsPixels) {
  for (const char* name : kLensNames) {
    const Scene scene = LensScene(name, 2, 30);
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const Eigen::MatrixXd J = NumericJacobian(
          [&](const Eigen::VectorXd& x) {
            ViewPair moved = scene;
            moved.cam2_from_cam1_true = Retract(scene.cam2_from_cam1_true, x.head<5>());
            const Eigen::Vector3d at = point + x.tail<3>();
            Eigen::Vector4d pixels;
            pixels << scene.camera1.Project(at), scene.camera2.Project(moved.InCamera2(at));
            return Eigen::VectorXd(pixels);
          },
          Eigen::VectorXd::Zero(8), 1e-3);
      const PointConstraint constraint = ComputePointConstraint(scene, point);
      const Eigen::RowVectorXd moved = constraint.gradient_px.transpose() * J;
      const double scale = constraint.gradient_motion.norm();
      EXPECT_LT(moved.tail(3).norm(), 1e-6 * scale) << name;
      EXPECT_LT((moved.head(5) - constraint.gradient_motion).norm(), 1e-6 * scale) << name;
    }
  }
}

TEST(PinholeMatch, IsTheExactMatchWithoutALensAndUndistortedWithOne) {
  for (const char* name : {"two_pinholes", "radtan", "fisheye"}) {
    const Scene scene = LensScene(name, 3, 20);
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      const Correspondence exact = ExactMatch(scene, point), pinhole = PinholeMatch(scene, point);
      EXPECT_LT((*Undistort(scene.camera1.AsLens(), exact.x1_px) - pinhole.x1_px).norm(), 1e-9) << name;
      EXPECT_LT((*Undistort(scene.camera2.AsLens(), exact.x2_px) - pinhole.x2_px).norm(), 1e-9) << name;
    }
  }
}

}  // namespace
}  // namespace rcme
