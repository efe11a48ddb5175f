#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

bool IsOnFloorOrCeiling(const Eigen::Vector3d& point) {
  return std::abs(point.y() - 1.2) < 1e-12 || std::abs(point.y() - (1.2 - 2.8)) < 1e-12;
}

// The points of walls and boxes.
std::vector<Eigen::Vector3d> Upright(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> upright;
  std::ranges::copy_if(points, std::back_inserter(upright),
                       [](const auto& p) { return !IsOnFloorOrCeiling(p); });
  return upright;
}

Eigen::Vector2d OnFloor(const Eigen::Vector3d& point, double yaw) {
  return {std::cos(yaw) * point.x() - std::sin(yaw) * point.z(),
          std::sin(yaw) * point.x() + std::cos(yaw) * point.z()};
}

// The yaw in [0, pi / 2) at which most of the points are level with the first one along an axis: a wall
// through the first point runs along that axis.
double FindYaw(const std::vector<Eigen::Vector3d>& walls) {
  double best_yaw = 0.0;
  std::ptrdiff_t most = -1;
  for (size_t i = 1; i < std::min<size_t>(walls.size(), 20); ++i) {
    const Eigen::Vector3d along = walls[i] - walls[0];
    const double quarter = 0.5 * std::numbers::pi;
    const double yaw = std::fmod(std::atan2(along.x(), along.z()) + 4.0 * quarter, quarter);
    const Eigen::Vector2d first = OnFloor(walls[0], yaw);
    const std::ptrdiff_t count = std::ranges::count_if(walls, [&](const Eigen::Vector3d& wall) {
      return (OnFloor(wall, yaw) - first).cwiseAbs().minCoeff() < 1e-9;
    });
    if (count > most) std::tie(most, best_yaw) = std::pair(count, yaw);
  }
  return best_yaw;
}

// Seen from inside, every wall is at an extreme of one of the two level coordinates.
TEST(Room, WithoutBoxesAllPointsLieOnARectangularRoomOfTheGivenSize) {
  SceneGenerator generator("room");
  Set(generator, {{"num_boxes", "0"}});
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    const std::vector<Eigen::Vector3d> walls = Upright(Generate(generator, trial).points_in_cam1);
    ASSERT_GT(walls.size(), 50u);
    const double yaw = FindYaw(walls);
    Eigen::Vector2d low = OnFloor(walls[0], yaw), high = low;
    for (const Eigen::Vector3d& wall : walls) {
      low = low.cwiseMin(OnFloor(wall, yaw));
      high = high.cwiseMax(OnFloor(wall, yaw));
    }
    EXPECT_LT((high - low).minCoeff(), 6.0 + 1e-9);
    EXPECT_LT((high - low).maxCoeff(), 8.0 + 1e-9);
    for (const Eigen::Vector3d& wall : walls) {
      const Eigen::Vector2d xz = OnFloor(wall, yaw);
      EXPECT_LT(std::min((xz - low).minCoeff(), (high - xz).minCoeff()), 1e-9);
      EXPECT_TRUE(wall.y() < 1.2 && wall.y() > 1.2 - 2.8);
      EXPECT_GT(xz.norm(), 1.5);  // from the camera, which stands in the middle half of 6 m
    }
  }
}

// 1,000 rooms, Kolmogorov-Smirnov at 1e-4; a tenth of the circle left out (sqrt(n) D = 3.2) is rejected.
TEST(Room, TheCameraLooksInAnyDirection) {
  const auto model = Configured(MakeRoom(), {{"num_boxes", "0"}});
  std::vector<double> quarters;
  for (std::uint32_t trial = 0; trial < 1000; ++trial) {
    const double yaw = FindYaw(Upright(Candidates(*DrawWorld(*model, trial), 0, 200)));
    quarters.push_back(yaw / (0.5 * std::numbers::pi));
  }
  EXPECT_GT(UniformPValue(quarters), 1e-4);
  for (double& quarter : quarters) quarter *= 0.9;
  EXPECT_LT(UniformPValue(quarters), 1e-6);
}

// Every ray in a closed room meets a surface: 5,000 points, Kolmogorov-Smirnov at 1e-4.
TEST(Room, TheFirstImagesAreUniform) {
  const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*MakeRoom()), 0, 5000);
  EXPECT_GT(UniformPValue(ImageX(points)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(points)), 1e-4);
}

// With the same stream up to the boxes, what boxes change is nearer than the wall, not beyond the bounds of a
// box, and not near the camera. They show in most rooms.
TEST(Room, BoxesStandOnTheFloorBeforeTheWallsAndLeaveTheCameraFree) {
  const auto bare = Configured(MakeRoom(), {{"num_boxes", "0"}}), furnished = MakeRoom();
  int num_with_boxes = 0;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*furnished, trial), 0, 500, trial);
    const std::vector<Eigen::Vector3d> behind = Candidates(*DrawWorld(*bare, trial), 0, 500, trial);
    bool has_boxes = false;
    for (size_t i = 0; i < points.size(); ++i) {
      if (points[i] == behind[i]) continue;
      has_boxes = true;
      EXPECT_LT(points[i].z(), behind[i].z());
      EXPECT_LT((points[i] / points[i].z() - behind[i] / behind[i].z()).norm(), 1e-14);
      EXPECT_GE(points[i].y(), 1.2 - 1.2 - 1e-12);  // the box is at most 1.2 m high, as high as the camera
      EXPECT_LE(points[i].y(), 1.2 + 1e-12);
      EXPECT_GE(std::hypot(points[i].x(), points[i].z()), 1.0 - 1e-12);
    }
    num_with_boxes += has_boxes;
  }
  EXPECT_GT(num_with_boxes, 50);
}

TEST(Room, ContradictionsAndImpossibleRequestsNameTheirKeysAndEnd) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("room");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"camera_height_m", "3"}}, {"camera_height_m: 3", "room_height_m = 2.8"}));
  EXPECT_TRUE(
      refuses({{"max_box_size_m", "7"}}, {"max_box_size_m: 7", "room_width_m = 6", "room_length_m = 8"}));
  EXPECT_TRUE(refuses({{"free_radius_m", "10"}}, {"num_boxes", "free_radius_m = 10", "room_width_m"}));
}

}  // namespace
}  // namespace rcme
