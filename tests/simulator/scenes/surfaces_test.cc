#include "simulator/scenes/surfaces.h"

#include <gtest/gtest.h>

#include <limits>

#include "simulator/camera_registry.h"
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

// The first depth on one ray.
double FirstDepth(const UprightCamera& camera, const Eigen::Vector3d& ray,
                  const std::vector<Rectangle>& rectangles) {
  RayBlock rays;
  rays.x.fill(ray.x());
  rays.y.fill(ray.y());
  return camera.FirstDepths(rays, rectangles)[PointBlock::kSize / 2];
}

TEST(UprightCamera, FirstDepthIsThatOfTheNearestRectangleOnTheRay) {
  const UprightCamera camera({}, {0, 0, 0}, 0.0), back({}, {0, 0, 0}, 0.5), near({}, {0, 0, 3.0}, 0.0);
  for (const std::vector<Rectangle>& both : {std::vector{kGround, kWall}, {kWall, kGround}}) {
    EXPECT_DOUBLE_EQ(FirstDepth(camera, {0.0, 0.0, 1.0}, both), 5.0);
    EXPECT_DOUBLE_EQ(FirstDepth(camera, {0.19, 0.09, 1.0}, both), 5.0);       // the floor is behind the wall
    EXPECT_DOUBLE_EQ(FirstDepth(camera, {0.25, 0.09, 1.0}, both), 1 / 0.09);  // past the wall, to the floor
    EXPECT_DOUBLE_EQ(FirstDepth(camera, {0.0, 0.25, 1.0}, both), 4.0);        // the floor before the wall
    EXPECT_EQ(FirstDepth(camera, {0.25, 0.04, 1.0}, both), kNone);            // beyond the floor's end
    EXPECT_EQ(FirstDepth(camera, {0.0, 0.6, 1.0}, both), kNone);              // before its beginning
    EXPECT_EQ(FirstDepth(camera, {0.0, -0.2, 1.0}, both), kNone);             // above all
    EXPECT_EQ(FirstDepth(back, {0.0, 0.0, 1.0}, both), kNone);
    EXPECT_DOUBLE_EQ(FirstDepth(near, {0.0, 0.0, 1.0}, both), 2.0);
  }
}

TEST(UprightCamera, DrawsPointsOnRectanglesAndNothingElsewhere) {
  const UprightCamera camera(StillView().camera1, {0, 0, 0}, 0.0);
  RandomStream rng({1, 0, 0, 1});
  PointBlock block;
  int num_drawn = 0;
  for (size_t i = 0; i < 2000; ++i) {
    if (i % PointBlock::kSize == 0) camera.DrawPoints(std::vector{kWall}, rng, &block);
    const size_t k = i % PointBlock::kSize;
    if (block.z_m[k] < 0.0) continue;
    ++num_drawn;
    EXPECT_NEAR(block.z_m[k], 5.0, 1e-14);
    EXPECT_LE(std::abs(block.x_m[k]), 1.0);
    EXPECT_LE(std::abs(block.y_m[k]), 0.5);
  }
  // The wall fills 280 x 140 of 640 x 480 px: 255 of 2000, standard deviation 15.
  EXPECT_NEAR(num_drawn, 255, 70);  // false alarms 3e-6
}

// Rectangles of any place and size around the camera.
std::vector<Rectangle> DrawRectangles(int n, RandomStream& rng) {
  std::vector<Rectangle> rectangles;
  for (int k = 0; k < n; ++k) {
    Rectangle rectangle{k % 3, {}, {}};
    for (int axis = 0; axis < 3; ++axis) {
      rectangle.low(axis) = rng.Uniform(-6.0, 5.0);
      rectangle.high(axis) = rectangle.low(axis) + (axis == k % 3 ? 0.0 : rng.Uniform(0.0, 3.0));
    }
    rectangles.push_back(rectangle);
  }
  return rectangles;
}

// One ray after another, and every rectangle on each.
Eigen::Vector3d DrawOnePoint(const SceneCamera& camera, const UprightCamera& upright,
                             const Eigen::Vector3d& centre, const std::vector<Rectangle>& rectangles,
                             RandomStream& rng) {
  const Eigen::Vector3d ray = DrawRay(camera, rng), direction = upright.InBuildingAxes(ray);
  double first = kNone;
  for (const auto& [n, low, high] : rectangles) {
    const double multiple = (low(n) - centre(n)) / direction(n);
    bool is_met = multiple > 0.0 && multiple < first;
    for (const int k : {(n + 1) % 3, (n + 2) % 3}) {
      const double coordinate = centre(k) + multiple * direction(k);
      is_met = is_met && coordinate >= low(k) && coordinate <= high(k);
    }
    if (is_met) first = multiple;
  }
  return first < kNone ? Eigen::Vector3d(first * ray) : UnseenPoint();
}

TEST(UprightCamera, ABlockHasTheBitsOfPointsDrawnOneByOneAndRectanglesOutOfViewDoNotMatter) {
  for (const char* cameras : {"pinhole", "fisheye"}) {
    const SceneCamera camera = FindEntry(CameraRegistry(), "cameras", cameras).make()->Make().first;
    size_t num_met = 0, num_in_view = 0;
    for (std::uint32_t trial = 0; trial < 50; ++trial) {
      RandomStream rng({1, 0, trial, 1}), one_by_one({1, 0, trial, 2}), at_once({1, 0, trial, 2});
      const Eigen::Vector3d centre(rng.Uniform(-1, 1), rng.Uniform(-1, 1), rng.Uniform(-1, 1));
      const UprightCamera upright(camera, centre, rng.Uniform(-1, 1));
      const std::vector<Rectangle> all = DrawRectangles(40, rng), in_view = upright.InView(all);
      num_in_view += in_view.size();
      PointBlock block;
      upright.DrawPoints(in_view, at_once, &block);
      for (size_t i = 0; i < PointBlock::kSize; ++i) {
        const Eigen::Vector3d point = DrawOnePoint(camera, upright, centre, all, one_by_one);
        ASSERT_EQ(point, Eigen::Vector3d(block.x_m[i], block.y_m[i], block.z_m[i]));
        num_met += point.z() > 0.0;
      }
      EXPECT_EQ(one_by_one.Next64(), at_once.Next64());
    }
    EXPECT_GT(num_met, 50 * PointBlock::kSize / 8);  // the comparison is not of empty blocks
    if (!camera.HasLens()) {
      EXPECT_LT(num_in_view, 50 * 40 / 2);
    }
  }
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
