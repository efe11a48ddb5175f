#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

TEST(Plane, AllPointsLieOnAPlaneOfTheGivenTiltThroughTheGivenDepth) {
  for (const double tilt_deg : {0.0, 30.0, 60.0}) {
    SceneGenerator generator("plane");
    Set(generator, {{"plane_tilt_deg", std::to_string(tilt_deg)}, {"plane_depth_m", "7"}});
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const FittedPlane plane = FitPlane(Generate(generator, trial).points_in_cam1);
      EXPECT_LT(plane.largest_residual, 7e-12);
      EXPECT_NEAR(AngleBetween(plane.normal, Eigen::Vector3d::UnitZ()) * 180.0 / std::numbers::pi, tilt_deg,
                  1e-9);
      EXPECT_NEAR(plane.distance / plane.normal.z(), 7.0, 1e-10);
    }
  }
}

// 5,000 points, Kolmogorov-Smirnov at 1e-4; points uniform on the plane itself would be denser where it is
// far: the test sees the depths of this sample as far from uniform.
TEST(Plane, TheFirstImagesAreUniform) {
  const auto model = Configured(MakePlane(), {{"plane_tilt_deg", "60"}});
  const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*model), 0, 5000);
  EXPECT_GT(UniformPValue(ImageX(points)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(points)), 1e-4);
  const std::vector<double> depths_m = Depths(points);
  EXPECT_LT(UniformPValue(depths_m, std::ranges::min(depths_m), std::ranges::max(depths_m)), 1e-10);
}

// The azimuths of 2,000 planes; Kolmogorov-Smirnov at 1e-4. Azimuths that leave out a fifth of the circle (D
// = 0.1, sqrt(n) D = 4.5) would give p < 1e-10.
TEST(Plane, TheTiltIsTowardsAnySide) {
  const auto model = MakePlane();
  std::vector<double> azimuths;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    const Eigen::Vector3d normal = FitPlane(Candidates(*DrawWorld(*model, trial), 0, 20)).normal;
    azimuths.push_back(std::atan2(normal.y(), normal.x()));
  }
  EXPECT_GT(UniformPValue(azimuths, -std::numbers::pi, std::numbers::pi), 1e-4);
  for (double& azimuth : azimuths) azimuth *= 0.8;
  EXPECT_LT(UniformPValue(azimuths, -std::numbers::pi, std::numbers::pi), 1e-10);
}

// Signed distances of 5,000 points from the plane, and their feet in image 1: Kolmogorov-Smirnov at 1e-4. A
// range 10 % larger (D = 0.045, sqrt(n) D = 3.2) would give p < 1e-8.
TEST(PlaneAndParallax, PointsOffThePlaneAreMovedAlongItsNormalUniformly) {
  const auto model = Configured(MakePlaneAndParallax(), {{"off_plane_m", "0.5"}});
  const auto world = DrawWorld(*model);
  const FittedPlane plane = FitPlane(Candidates(*world, 0, 1000));
  std::vector<double> distances_m;
  std::vector<Eigen::Vector3d> feet;
  for (const Eigen::Vector3d& point : Candidates(*world, 1, 5000)) {
    distances_m.push_back(plane.normal.dot(point) - plane.distance);
    feet.push_back(point - distances_m.back() * plane.normal);
  }
  EXPECT_GT(UniformPValue(distances_m, -0.5, 0.5), 1e-4);
  EXPECT_GT(UniformPValue(ImageX(feet)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(feet)), 1e-4);
  EXPECT_LT(UniformPValue(distances_m, -0.55, 0.55), 1e-6);
}

// The part on the plane comes first: a hundred of its points give the plane, and as many as the share says
// are off it.
TEST(PlaneAndParallax, TheShareOffThePlaneIsExact) {
  SceneGenerator generator("plane_and_parallax");
  for (const auto& [share, num_off] : {std::pair{"0", 0}, {"0.2", 100}, {"0.5", 250}}) {
    Set(generator, {{"off_plane_share", share}});
    const std::vector<Eigen::Vector3d> points = Generate(generator, 0).points_in_cam1;
    const FittedPlane plane = FitPlane({points.begin(), points.begin() + 100});
    EXPECT_EQ(std::ranges::count_if(points,
                                    [&, &p = plane](const Eigen::Vector3d& point) {
                                      return std::abs(p.normal.dot(point) - p.distance) > 1e-10;
                                    }),
              num_off);
  }
}

// At the steepest tilt the plane's horizon is in the image: nothing beyond it, all on the plane, no hang.
TEST(Plane, BeyondTheHorizonThereIsNothing) {
  const auto model = Configured(MakePlane(), {{"plane_tilt_deg", "89"}});
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    for (const Eigen::Vector3d& point : Candidates(*DrawWorld(*model, trial), 0, 500)) {
      ASSERT_TRUE(point.allFinite());
      ASSERT_GT(point.z(), 0.0);
    }
  }
}

TEST(Plane, AnImpossibleRequestNamesTheKeys) {
  SceneGenerator generator("plane");
  Set(generator, {{"focal_px", "1000000"}});  // the disparity is 100,000 px
  EXPECT_TRUE(
      ThrowsInputError([&] { Generate(generator, 0); }, {"plane_depth_m", "off_plane_m", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
