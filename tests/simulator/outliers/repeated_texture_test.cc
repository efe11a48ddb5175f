#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>

#include "simulator/outliers/outlier_laws.h"
#include "stats/distributions.h"
#include "tests/simulator/outliers/wrong_matches.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

using Steps = std::pair<int, int>;

// The whole numbers of steps along the scene's two directions whose point is seen nearest to the wrong one,
// and the distance (px).
std::pair<Steps, double> Explain(const Scene& scene, const Eigen::Vector3d& point,
                                 const Eigen::Vector2d& x2_px, int max_steps) {
  std::pair<Steps, double> best{{0, 0}, std::numeric_limits<double>::infinity()};
  for (int i = -max_steps; i <= max_steps; ++i) {
    for (int j = -max_steps; j <= max_steps; ++j) {
      const Eigen::Vector3d other = point + i * scene.repeat_steps_m[0] + j * scene.repeat_steps_m[1];
      const double distance_px = (ExactMatch(scene, other).x2_px - x2_px).norm();
      if (distance_px < best.second) best = {{i, j}, distance_px};
    }
  }
  return best;
}

// Every wrong match is, to rounding, the image of another repetition, never of the true point.
TEST(RepeatedTexture, IsTheImageOfAnotherRepetition) {
  const auto law = WithSettings(MakeRepeatedTexture(), {{"max_repeat_steps", "3"}});
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const Scene scene = SceneForOutliers(200, trial);
    const DrawnOutliers wrong = MakeWrong(*law, scene, 200, 0.5, trial);
    for (size_t i = 0; i < 200; ++i) {
      EXPECT_EQ(wrong.matches[i].x1_px, wrong.noisy[i].x1_px);
      const Eigen::Vector2d noise_px = wrong.noisy[i].x2_px - wrong.exact[i].x2_px;
      const Eigen::Vector2d x2_px = wrong.matches[i].x2_px - noise_px;
      EXPECT_TRUE(scene.camera2.IsInImage(x2_px));
      const auto [steps, distance_px] = Explain(scene, scene.points_in_cam1[i], x2_px, 3);
      EXPECT_LT(distance_px, 1e-9);
      EXPECT_NE(steps, Steps(0, 0));
      EXPECT_FALSE(wrong.is_undetectable[i]);
    }
  }
}

// With defects of the cameras, and where matches show points in another order: image 2 of a repetition of the
// shown point.
TEST(RepeatedTexture, IsTheImageOfARepetitionOfTheShownPointWithTheDefects) {
  const CameraDefects defects{.distortion_k1 = 0.05, .rolling_shutter = 0.1};
  Scene scene = SceneForOutliers(100, 2);
  scene.repeat_steps_m = {{0.05, 0.0, 0.0}};
  std::vector<std::uint32_t> shown(100);
  for (std::uint32_t i = 0; i < 100; ++i) shown[i] = i / 2;
  const DrawnOutliers wrong = MakeWrong(*MakeRepeatedTexture(), scene, 100, 0.0, 2, defects, shown);
  for (size_t i = 0; i < 100; ++i) {
    double nearest_px = std::numeric_limits<double>::infinity();
    for (const int steps : {-2, -1, 1, 2}) {
      const Eigen::Vector3d other = scene.points_in_cam1[shown[i]] + steps * scene.repeat_steps_m[0];
      nearest_px =
          std::min(nearest_px, (ImagedMatch(scene, defects, other).x2_px - wrong.matches[i].x2_px).norm());
    }
    EXPECT_LT(nearest_px, 1e-9);
    EXPECT_EQ(wrong.matches[i].x1_px, wrong.exact[i].x1_px);
  }
}

// Where every repetition is in view, all 24 of up to two steps either way are equally likely: chi-square with
// 23 degrees of freedom at 1e-4; were two steps along an axis half as likely as one, it would be seen.
TEST(RepeatedTexture, AllRepetitionsAreEquallyLikely) {
  Scene scene = SceneForOutliers(5000);
  scene.repeat_steps_m = {{1e-4, 0.0, 0.0}, {0.0, 1e-4, 0.0}};
  const DrawnOutliers wrong = MakeWrong(*MakeRepeatedTexture(), scene, 5000);
  std::map<Steps, double> counts;
  for (size_t i = 0; i < 5000; ++i) {
    ++counts[Explain(scene, scene.points_in_cam1[i], wrong.matches[i].x2_px, 2).first];
  }
  ASSERT_EQ(counts.size(), 24u);
  const auto chi_square = [&](auto weight) {
    double total = 0.0, sum = 0.0;
    for (const auto& [steps, count] : counts) total += weight(steps);
    for (const auto& [steps, count] : counts) {
      const double expected = 5000.0 * weight(steps) / total;
      sum += (count - expected) * (count - expected) / expected;
    }
    return sum;
  };
  const double limit = ChiSquareQuantile(23, 1.0 - 1e-4);
  EXPECT_LT(chi_square([](Steps) { return 1.0; }), limit);
  EXPECT_GT(chi_square([](Steps steps) { return std::abs(steps.first) == 2 ? 0.5 : 1.0; }), 2.0 * limit)
      << "no power";
}

TEST(RepeatedTexture, AStepOfItsOwnRunsAlongXOfCamera1) {
  Scene scene = SceneForOutliers(100);
  scene.repeat_steps_m.clear();
  const auto law = WithSettings(MakeRepeatedTexture(), {{"repeat_step_m", "0.2"}});
  const DrawnOutliers wrong = MakeWrong(*law, scene, 100);
  scene.repeat_steps_m = {{0.2, 0.0, 0.0}, {0.0, 1e6, 0.0}};  // the second one explains nothing
  for (size_t i = 0; i < 100; ++i) {
    EXPECT_LT(Explain(scene, scene.points_in_cam1[i], wrong.matches[i].x2_px, 2).second, 1e-9);
  }
}

// Steps along the baseline keep the point in its epipolar plane: the match satisfies the constraint and is
// flagged. Steps across do not and are not.
TEST(RepeatedTexture, StepsAlongTheBaselineAreFlagged) {
  Scene scene = SceneForOutliers(100);
  const RelativePose& pose = scene.cam2_from_cam1_true;
  const Eigen::Vector3d along = pose.R.transpose() * pose.t;
  const Eigen::Vector3d across = along.cross(Eigen::Vector3d::UnitZ()).normalized();
  for (const bool is_along : {true, false}) {
    scene.repeat_steps_m = {0.05 * (is_along ? along : across)};
    const DrawnOutliers wrong = MakeWrong(*MakeRepeatedTexture(), scene, 100);
    for (size_t i = 0; i < 100; ++i) {
      EXPECT_EQ(wrong.is_undetectable[i], is_along);
      EXPECT_EQ(std::abs(TripleProduct(scene, wrong.matches[i])) < 1e-12, is_along);
    }
  }
}

TEST(RepeatedTexture, ASceneWithoutRepetitionsAndStepsBeyondTheImageNameTheKeys) {
  Scene scene = SceneForOutliers(10);
  scene.repeat_steps_m.clear();
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*MakeRepeatedTexture(), scene, 1); }, {"repeat_step_m"}));
  const auto far = WithSettings(MakeRepeatedTexture(), {{"repeat_step_m", "1000"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakeWrong(*far, scene, 1); }, {"max_repeat_steps: 2", "repeat_step_m"}));
}

}  // namespace
}  // namespace rcme
