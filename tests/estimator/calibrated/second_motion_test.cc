#include "estimator/calibrated/second_motion.h"

#include <gtest/gtest.h>

#include <numeric>

#include "estimator/calibrated/part_search.h"
#include "estimator/noise_scale.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

// 120 matches of an object in a small part of image 1, 80 of the scene, which the first mode does not
// explain.
struct ObjectInScene {
  RelativePose camera;
  FittedMode of_object;
};
ObjectInScene FitObjectInScene(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2841});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 200});
  const RelativePose& camera = random.pose_true;
  const RelativePose moved{RotationFromVector(0.1 * RandomDirection(rng)) * camera.R,
                           (camera.t + 0.5 * RandomDirection(rng)).normalized()};
  const Eigen::Vector3d centre(0.0, 0.0, 8.0);
  for (size_t i = 0; i < 120; ++i) {
    const Eigen::Vector3d point = centre + Eigen::Vector3d(rng.Normal(), rng.Normal(), rng.Normal());
    random.problem.matches[i] = ProjectToBoth(point, moved, random.problem.camera1, random.problem.camera2);
  }
  AddNoise(0.5, rng, &random.problem);
  std::vector<int> order(200);
  std::iota(order.begin(), order.end(), 0);
  rng.Shuffle(std::span<int>(order));
  return {camera, FitFromTruth(SelectPart(random.problem, order), moved)};
}

// Samples of all matches would lie on the scene in one of a hundred. The search misses 3 of 1,000 such
// scenes, so that it misses three of twenty with a probability of 3e-5.
TEST(AddSecondMotion, FindsTheSceneBesideAnObjectWithMostMatches) {
  int num_found = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const auto [camera, f] = FitObjectInScene(trial);
    std::vector<Mode> modes = {f.mode};
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2842});
    AddSecondMotion(f.problem, f.matches, f.prior, &modes, rng);
    num_found += modes.size() == 2 && RotationAngleBetween(modes[1].pose.R, camera.R) < 0.02;
  }
  EXPECT_GE(num_found, 18);
}

// Nor does it draw a number: what comes afterwards does not depend on it.
TEST(AddSecondMotion, DoesNotSearchAmongUnrelatedMatches) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const FittedMode f = FitScene(200, 0.5, 0.5, trial);
    std::vector<Mode> modes = {f.mode};
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2843}), same = rng;
    AddSecondMotion(f.problem, f.matches, f.prior, &modes, rng);
    EXPECT_EQ(modes.size(), 1U) << trial;
    EXPECT_EQ(rng.Uniform(), same.Uniform()) << trial;
  }
}

TEST(AddSecondMotion, NeedsAFirstMode) {
  const auto [camera, f] = FitObjectInScene(1);
  std::vector<Mode> modes;
  RandomStream rng({.seed = 1, .purpose = 2842});
  AddSecondMotion(f.problem, f.matches, f.prior, &modes, rng);
  EXPECT_TRUE(modes.empty());
}

// A mode of the scene at a noise level far too low explains few of its matches, so that the search finds
// the scene once more.
TEST(AddSecondMotion, AddsNoModeThatIsThere) {
  const auto [camera, f] = FitObjectInScene(1);
  std::vector<Mode> modes = {f.mode};
  RandomStream rng({.seed = 1, .purpose = 2842});
  AddSecondMotion(f.problem, f.matches, f.prior, &modes, rng);
  ASSERT_EQ(modes.size(), 2U);
  modes[1].mixture.scale = 0.01;
  ASSERT_GE(FindUnexplained(Explain(f.matches, modes[1])).size(), 160U);
  AddSecondMotion(f.problem, f.matches, f.prior, &modes, rng);
  EXPECT_EQ(modes.size(), 2U);
}

}  // namespace
}  // namespace rcme
