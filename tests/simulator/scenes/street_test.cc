#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

enum StreetPart { kRoad, kFacades, kFar };

TEST(Street, RoadAndFacadesAreWhereTheParametersSay) {
  const auto world = DrawWorld(*Configured(
      MakeStreet(), {{"max_heading_deg", "0"}, {"facade_distance_m", "6"}, {"facade_height_m", "12"}}));
  for (const Eigen::Vector3d& point : Candidates(*world, kRoad, 1000)) {
    EXPECT_NEAR(point.y(), 1.65, 1e-12);
    EXPECT_LE(std::abs(point.x()), 6.0 + 1e-12);
    EXPECT_LE(point.z(), 60.0 + 1e-9);
  }
  int num_left = 0;
  for (const Eigen::Vector3d& point : Candidates(*world, kFacades, 1000)) {
    EXPECT_NEAR(std::abs(point.x()), 6.0, 1e-12);
    EXPECT_TRUE(point.y() <= 1.65 && point.y() >= 1.65 - 12.0);
    EXPECT_LE(point.z(), 60.0 + 1e-9);
    num_left += point.x() < 0.0;
  }
  EXPECT_NEAR(num_left, 500, 75);  // half, standard deviation 16: false alarms 2e-6
}

// 5,000 points, Kolmogorov-Smirnov at 1e-4 in depth, across the image, and in height (heights against a
// camera that sees all of them: 10 m at 60 m is 117 px). A street 5 % longer is rejected (sqrt(n) D = 3.3).
TEST(Street, FarPointsAreUniformInDepthAcrossTheImageAndInHeight) {
  const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*MakeStreet()), kFar, 5000);
  std::vector<double> heights_m;
  for (const Eigen::Vector3d& point : points) heights_m.push_back(1.65 - point.y());
  EXPECT_GT(UniformPValue(Depths(points), 60.0, 300.0), 1e-4);
  EXPECT_GT(UniformPValue(ImageX(points)), 1e-4);
  EXPECT_GT(UniformPValue(heights_m, 0.0, 10.0), 1e-4);
  EXPECT_LT(UniformPValue(Depths(points), 63.0, 315.0), 1e-6);
}

// On a road as wide as the image: 5,000 points, Kolmogorov-Smirnov at 1e-4; as in the corridor.
TEST(Street, TheFirstImagesAreUniformOverTheRoad) {
  const auto world =
      DrawWorld(*Configured(MakeStreet(), {{"facade_distance_m", "1000"}, {"max_heading_deg", "0"}}));
  const std::vector<Eigen::Vector3d> points = Candidates(*world, kRoad, 5000);
  EXPECT_GT(UniformPValue(ImageX(points)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(points), 0.5 + 700.0 / 480.0 * 1.65 / 60.0, 1.0), 1e-4);
  EXPECT_LT(UniformPValue(Depths(points), 1.65 * 700.0 / 240.0, 60.0), 1e-10);
}

// Headings of 2,000 streets from the right facade; Kolmogorov-Smirnov at 1e-4, and 3.5 deg is rejected
// (sqrt(n) D = 3.2).
TEST(Street, TheHeadingIsUniform) {
  const auto model = MakeStreet();
  std::vector<double> headings_deg;
  for (std::uint32_t trial = 0; trial < 2000; ++trial) {
    std::vector<Eigen::Vector3d> right;
    for (const Eigen::Vector3d& point : Candidates(*DrawWorld(*model, trial), kFacades, 40)) {
      if (point.x() / point.z() > 0.1) right.push_back(point);
    }
    ASSERT_GE(right.size(), 2u);
    const auto [near, far] = std::ranges::minmax_element(right, {}, Coordinate(2));
    const Eigen::Vector3d along = *far - *near;
    headings_deg.push_back(std::atan2(-along.x(), along.z()) * 180.0 / std::numbers::pi);
    EXPECT_NEAR(near->x() * along.z() - near->z() * along.x(), 8.0 * std::hypot(along.x(), along.z()), 1e-7);
  }
  EXPECT_GT(UniformPValue(headings_deg, -3.0, 3.0), 1e-4);
  EXPECT_LT(UniformPValue(headings_deg, -3.5, 3.5), 1e-6);
}

TEST(Street, SharesAreExact) {
  SceneGenerator generator("street");
  Set(generator, {{"max_heading_deg", "0"}, {"road_share", "0.36"}, {"facade_share", "0.44"}});
  const std::vector<Eigen::Vector3d> points = Generate(generator, 0).points_in_cam1;
  const auto count = [&](const auto& is_on) { return std::ranges::count_if(points, is_on); };
  EXPECT_EQ(count([](const auto& point) { return point.z() >= 60.0; }), 100);
  EXPECT_EQ(count([](const auto& point) { return std::abs(point.y() - 1.65) < 1e-12; }), 180);
  EXPECT_EQ(count([](const auto& point) { return std::abs(std::abs(point.x()) - 8.0) < 1e-12; }), 220);
}

TEST(Street, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("street");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"road_share", "0.7"}}, {"road_share: 0.7", "facade_share = 0.5"}));
  EXPECT_TRUE(refuses({{"camera_height_m", "1000"}}, {"camera_height_m", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
