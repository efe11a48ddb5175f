#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

enum Part { kWalls, kFloor, kCeiling };

TEST(Corridor, WallsFloorAndCeilingAreWhereTheParametersSay) {
  const auto model = Configured(MakeCorridor(), {{"corridor_width_m", "3"},
                                                 {"corridor_height_m", "2.5"},
                                                 {"camera_height_m", "1"},
                                                 {"max_heading_deg", "0"}});
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const auto world = DrawWorld(*model, trial);
    const std::vector<Eigen::Vector3d> walls = Candidates(*world, kWalls, 500);
    const auto [leftmost, rightmost] = std::ranges::minmax_element(walls, {}, Coordinate(0));
    EXPECT_NEAR(rightmost->x() - leftmost->x(), 3.0, 1e-12);
    EXPECT_LE(std::abs(rightmost->x() + leftmost->x()), 1.5);  // twice the camera's place, in the middle half
    for (const Eigen::Vector3d& point : walls) {
      EXPECT_NEAR(point.x(), (point.x() < 0.0 ? leftmost : rightmost)->x(), 1e-12);
      EXPECT_TRUE(point.y() >= -1.5 && point.y() <= 1.0 && point.z() <= 20.0);
    }
    for (const Eigen::Vector3d& point : Candidates(*world, kFloor, 500)) {
      EXPECT_NEAR(point.y(), 1.0, 1e-12);
      EXPECT_TRUE(point.x() >= leftmost->x() && point.x() <= rightmost->x() && point.z() <= 20.0);
    }
    for (const Eigen::Vector3d& point : Candidates(*world, kCeiling, 500))
      EXPECT_NEAR(point.y(), -1.5, 1e-12);
  }
}

// On a floor as wide as the image the first images are uniform from the row of the corridor's end to the
// lower border: 5,000 points, Kolmogorov-Smirnov at 1e-4. Points uniform on the floor itself would have
// uniform depths: the test rejects them.
TEST(Corridor, TheFirstImagesAreUniformOverEachPart) {
  const auto world =
      DrawWorld(*Configured(MakeCorridor(), {{"corridor_width_m", "1000"}, {"max_heading_deg", "0"}}));
  const std::vector<Eigen::Vector3d> points = Candidates(*world, kFloor, 5000);
  const double row_of_end = 0.5 + 700.0 / 480.0 * 1.2 / 20.0;
  EXPECT_GT(UniformPValue(ImageX(points)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(points), row_of_end, 1.0), 1e-4);
  EXPECT_LT(UniformPValue(Depths(points), 1.2 * 700.0 / 240.0, 20.0), 1e-10);
}

// Heading and place of 2,000 corridors from two points of the left wall; Kolmogorov-Smirnov at 1e-4. A bound
// of 6 deg (D = 0.083, sqrt(n) D = 3.7) is rejected.
TEST(Corridor, HeadingAndPlaceOfTheCameraAreUniform) {
  const auto model = MakeCorridor();
  std::vector<double> headings_deg, distances_m;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    std::vector<Eigen::Vector3d> left_wall;
    for (const Eigen::Vector3d& point : Candidates(*DrawWorld(*model, trial), kWalls, 40)) {
      if (point.x() / point.z() < -0.25)
        left_wall.push_back(point);  // the vanishing point is nearer the middle
    }
    ASSERT_GE(left_wall.size(), 2u);
    const auto [near, far] = std::ranges::minmax_element(left_wall, {}, Coordinate(2));
    const Eigen::Vector3d along = *far - *near;
    const double heading = std::atan2(-along.x(), along.z());  // to the right: the wall runs to the left
    headings_deg.push_back(heading * 180.0 / std::numbers::pi);
    distances_m.push_back(-near->x() * std::cos(heading) - near->z() * std::sin(heading));
  }
  EXPECT_GT(UniformPValue(headings_deg, -5.0, 5.0), 1e-4);
  EXPECT_GT(UniformPValue(distances_m, 0.6, 1.8), 1e-4);  // the middle half of 2.4 m, from the left wall
  EXPECT_LT(UniformPValue(headings_deg, -6.0, 6.0), 1e-6);
}

TEST(Corridor, SharesAreExact) {
  SceneGenerator generator("corridor");
  Set(generator, {{"max_heading_deg", "0"}, {"walls_share", "0.5"}, {"floor_share", "0.3"}});
  const std::vector<Eigen::Vector3d> points = Generate(generator, 0).points_in_cam1;
  const auto count_at = [&](double y_m) {
    return std::ranges::count_if(points,
                                 [&](const auto& point) { return std::abs(point.y() - y_m) < 1e-12; });
  };
  EXPECT_EQ(count_at(1.2), 150);
  EXPECT_EQ(count_at(1.2 - 2.6), 100);
}

TEST(Corridor, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("corridor");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"camera_height_m", "3"}}, {"camera_height_m: 3", "corridor_height_m = 2.6"}));
  EXPECT_TRUE(refuses({{"walls_share", "0.9"}}, {"walls_share: 0.9", "floor_share = 0.2"}));
  EXPECT_TRUE(refuses({{"corridor_length_m", "0.5"}}, {"corridor_length_m", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
