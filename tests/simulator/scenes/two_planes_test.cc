#include <gtest/gtest.h>

#include <cmath>

#include "simulator/scenes/scenes.h"
#include "stats/constants.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

// Both planes are vertical and go through the edge at the given depth; seen from the camera they make the
// given angle. The fitted normals point away from the camera: for the left plane of an inner corner to the
// left.
TEST(TwoPlanes, TheyMeetInTheGivenEdgeAtTheGivenAngle) {
  for (const double dihedral_deg : {60.0, 90.0, 150.0, 210.0, 270.0}) {
    const auto model = Configured(MakeTwoPlanes(), {{"dihedral_deg", std::to_string(dihedral_deg)}});
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const auto world = DrawWorld(*model, trial);
      const FittedPlane left = FitPlane(Candidates(*world, 0, 500, trial));
      const FittedPlane right = FitPlane(Candidates(*world, 1, 500, trial));
      for (const FittedPlane& plane : {left, right}) {
        EXPECT_LT(plane.largest_residual, 1e-11);
        EXPECT_NEAR(plane.normal.y(), 0.0, 1e-12);
        EXPECT_NEAR(plane.distance / plane.normal.z(), 6.0, 1e-10);
      }
      const double left_deg = std::atan2(left.normal.x(), left.normal.z()) * kDegPerRad;
      const double right_deg = std::atan2(right.normal.x(), right.normal.z()) * kDegPerRad;
      EXPECT_NEAR(180.0 - (right_deg - left_deg), dihedral_deg, 1e-9);
    }
  }
}

// The turns of 2,000 corners, from the bisector of the normals; Kolmogorov-Smirnov at 1e-4 with 20 deg, and
// the same test rejects 24 deg (D = 0.083, sqrt(n) D = 3.7).
TEST(TwoPlanes, TheCornerIsTurnedUniformlyWithinItsBound) {
  const auto model = MakeTwoPlanes();
  std::vector<double> turns_deg;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    const auto world = DrawWorld(*model, trial);
    double sum_deg = 0.0;
    for (const size_t part : {0, 1}) {
      const Eigen::Vector3d normal = FitPlane(Candidates(*world, part, 20, trial)).normal;
      sum_deg += std::atan2(normal.x(), normal.z()) * kDegPerRad;
    }
    turns_deg.push_back(0.5 * sum_deg);
  }
  EXPECT_GT(UniformPValue(turns_deg, -20.0, 20.0), 1e-4);
  EXPECT_LT(UniformPValue(turns_deg, -24.0, 24.0), 1e-6);
}

// 5,000 points each, Kolmogorov-Smirnov at 1e-4; points of one plane all over the image would be rejected.
TEST(TwoPlanes, TheFirstImagesOfEachPlaneAreUniformOverItsHalf) {
  const auto world = DrawWorld(*MakeTwoPlanes());
  for (const size_t part : {0, 1}) {
    const std::vector<Eigen::Vector3d> points = Candidates(*world, part, 5000);
    const double low = part == 0 ? 0.0 : 0.5;
    EXPECT_GT(UniformPValue(ImageX(points), low, low + 0.5), 1e-4);
    EXPECT_GT(UniformPValue(ImageY(points)), 1e-4);
    EXPECT_LT(UniformPValue(ImageX(points)), 1e-10);
  }
}

TEST(TwoPlanes, TheShareOfTheFirstPlaneIsExact) {
  SceneGenerator generator("two_planes");
  for (const auto& [share, num_left] : {std::pair{"0.5", 250}, {"0.1", 50}, {"1", 500}}) {
    Set(generator, {{"first_plane_share", share}});
    const std::vector<Eigen::Vector3d> points = Generate(generator, 0).points_in_cam1;
    EXPECT_EQ(std::ranges::count_if(points, [](const Eigen::Vector3d& point) { return point.x() < 0.0; }),
              num_left);
  }
}

TEST(TwoPlanes, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("two_planes");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(
      refuses({{"max_corner_turn_deg", "50"}}, {"max_corner_turn_deg: 50", "dihedral_deg = 90", "45"}));
  EXPECT_TRUE(
      refuses({{"dihedral_deg", "350"}}, {"max_corner_turn_deg: 20", "dihedral_deg = 350", "than 5"}));
  EXPECT_TRUE(refuses({{"focal_px", "1000000"}}, {"edge_depth_m", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
