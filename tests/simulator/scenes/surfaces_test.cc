#include "simulator/scenes/surfaces.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulator/scenes/shares.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// A wall 2 m wide and 1 m high at z = 5 m, and a floor at y = 1 m from z = 2 m to 20 m.
const Rectangle kWall{2, {-1.0, -0.5, 5.0}, {1.0, 0.5, 5.0}};
const Rectangle kGround{1, {-10.0, 1.0, 2.0}, {10.0, 1.0, 20.0}};

TEST(UprightCamera, ARightTurnCarriesTheOpticalAxisToTheRight) {
  const UprightCamera ahead({}, {0, 0, 0}, 0.0), right({}, {0, 0, 0}, 0.25), left({}, {0, 0, 0}, -0.125);
  const Eigen::Vector3d axis(0, 0, 1), down(0, 1, 0);
  EXPECT_LT((ahead.InBuildingAxes({0.3, 0.2, 1.0}) - Eigen::Vector3d(0.3, 0.2, 1.0)).norm(), 1e-15);
  EXPECT_LT((right.InBuildingAxes(axis) - Eigen::Vector3d(1, 0, 0)).norm(), 1e-15);
  EXPECT_LT((right.InBuildingAxes({1, 0, 0}) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-15);
  EXPECT_LT((left.InBuildingAxes(axis) - Eigen::Vector3d(-1, 0, 1).normalized()).norm(), 1e-15);
  EXPECT_EQ(left.InBuildingAxes(down), down);
}

TEST(UprightCamera, FirstDepthIsThatOfTheNearestRectangleOnTheRay) {
  const UprightCamera camera({}, {0, 0, 0}, 0.0), back({}, {0, 0, 0}, 0.5), near({}, {0, 0, 3.0}, 0.0);
  for (const std::vector<Rectangle>& both : {std::vector{kGround, kWall}, {kWall, kGround}}) {
    EXPECT_DOUBLE_EQ(camera.FirstDepth({0.0, 0.0, 1.0}, both), 5.0);
    EXPECT_DOUBLE_EQ(camera.FirstDepth({0.19, 0.09, 1.0}, both), 5.0);       // the floor is behind the wall
    EXPECT_DOUBLE_EQ(camera.FirstDepth({0.25, 0.09, 1.0}, both), 1 / 0.09);  // past the wall, to the floor
    EXPECT_DOUBLE_EQ(camera.FirstDepth({0.0, 0.25, 1.0}, both), 4.0);        // the floor before the wall
    EXPECT_EQ(camera.FirstDepth({0.25, 0.04, 1.0}, both), kNone);            // beyond the floor's end
    EXPECT_EQ(camera.FirstDepth({0.0, 0.6, 1.0}, both), kNone);              // before its beginning
    EXPECT_EQ(camera.FirstDepth({0.0, -0.2, 1.0}, both), kNone);             // above all
    EXPECT_EQ(back.FirstDepth({0.0, 0.0, 1.0}, both), kNone);
    EXPECT_DOUBLE_EQ(near.FirstDepth({0.0, 0.0, 1.0}, both), 2.0);
  }
}

TEST(UprightCamera, DrawsPointsOnRectanglesAndNothingElsewhere) {
  const UprightCamera camera(StillView().camera1, {0, 0, 0}, 0.0);
  RandomStream rng({1, 0, 0, 1});
  int num_drawn = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d point = camera.DrawPoint(std::vector{kWall}, rng);
    if (point.z() < 0.0) continue;
    ++num_drawn;
    EXPECT_NEAR(point.z(), 5.0, 1e-14);
    EXPECT_LE(std::abs(point.x()), 1.0);
    EXPECT_LE(std::abs(point.y()), 0.5);
  }
  // The wall fills 280 x 140 of 640 x 480 px: 255 of 2000, standard deviation 15.
  EXPECT_NEAR(num_drawn, 255, 70);  // false alarms 3e-6
}

TEST(RestOfShares, IsWhatTwoSharesLeaveAndNamesBothKeysIfTheyLeaveLessThanNothing) {
  EXPECT_DOUBLE_EQ(RestOfShares({"a", 0.5}, {"b", 0.25}), 0.25);
  for (int i = 0; i <= 1000; ++i)
    EXPECT_NEAR(RestOfShares({"a", i / 1000.0}, {"b", 1.0 - i / 1000.0}), 0.0, 1e-15);
  EXPECT_TRUE(ThrowsInputError(
      [] {
        RestOfShares({"a_share", 0.7}, {"b_share", 0.5});
      },
      {"a_share: 0.7 is not allowed", "b_share = 0.5", "at most 0.5"}));
}

}  // namespace
}  // namespace rcme
