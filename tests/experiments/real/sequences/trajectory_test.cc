// Where a camera was between two known poses.
#include "experiments/real/sequences/trajectory.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

TEST(Trajectory, IsTakenBetweenItsPosesAndNowhereElse) {
  Trajectory trajectory;
  const CameraPose a{RotationFromVector({0, 0, 0.1}), {0, 0, 0}},
      b{RotationFromVector({0, 0, 0.3}), {2, 0, 4}};
  EXPECT_TRUE(trajectory.Add(1.0, a));
  EXPECT_TRUE(trajectory.Add(2.0, b));
  EXPECT_FALSE(trajectory.Add(2.0, b));
  EXPECT_FALSE(trajectory.Add(1.5, b));
  const std::optional<CameraPose> between = trajectory.At(1.25, 1.0);
  ASSERT_TRUE(between.has_value());
  EXPECT_LT((between->center - Eigen::Vector3d(0.5, 0, 1)).norm(), 1e-12);
  EXPECT_LT((between->R_world_from_cam - RotationFromVector({0, 0, 0.15})).norm(), 1e-12);
  EXPECT_TRUE(trajectory.At(1.0, 0.5).has_value());
  EXPECT_TRUE(trajectory.At(2.0, 0.5).has_value());
  for (const double outside : {0.999, 2.001}) EXPECT_FALSE(trajectory.At(outside, 1.0).has_value());
  EXPECT_FALSE(trajectory.At(1.5, 0.5).has_value());  // a gap
}

}  // namespace
}  // namespace rcme
