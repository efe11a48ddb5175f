// Which modes are added to those that the samples found, and which matches they leave out.
#include "estimator/calibrated/explain_matches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

int CountOf(const std::vector<ExplainedMode>& modes, ModeOrigin origin) {
  return static_cast<int>(
      std::ranges::count_if(modes, [&](const ExplainedMode& m) { return m.mode.origin == origin; }));
}

// Points of a plane in front of camera 1, or anywhere between 4 and 16 baselines, seen with noise.
MotionProblem SceneOf(int num_matches, bool is_plane, std::uint32_t trial, RelativePose* pose_true) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2820});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  if (is_plane) {
    for (size_t i = 0; i < random.points_in_cam1.size(); ++i) {
      const Eigen::Vector3d ray = random.points_in_cam1[i] / random.points_in_cam1[i].z();
      const Eigen::Vector3d point = ray / Eigen::Vector3d(0.05, 0.02, 0.15).dot(ray);
      random.problem.matches[i] =
          ProjectToBoth(point, random.pose_true, random.problem.camera1, random.problem.camera2);
    }
  }
  AddNoise(0.5, rng, &random.problem);
  *pose_true = random.pose_true;
  return random.problem;
}

std::vector<ExplainedMode> Explained(const MotionProblem& problem, const std::vector<RelativePose>& poses) {
  const MatchBlocks matches(problem);
  const MixturePrior prior = PriorOf(problem);
  std::vector<Mode> modes;
  for (const RelativePose& pose : poses) {
    Mode mode = StartMode(matches, prior, pose);
    if (FitMode(matches, prior, 50, &mode)) modes.push_back(mode);
  }
  return ExplainMatches(problem, matches, prior, CalibratedOptions(), modes);
}

// The other motion of a plane is added in nearly every scene of one, and in none whose points fill a volume.
TEST(ExplainMatches, AddsTheOtherMotionOfAPlaneAlone) {
  int num_of_planes = 0, num_of_volumes = 0;
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    RelativePose pose;
    const MotionProblem plane = SceneOf(100, true, trial, &pose);
    num_of_planes += CountOf(Explained(plane, {pose}), ModeOrigin::kTwistedPair) > 0;
    const MotionProblem volume = SceneOf(100, false, trial, &pose);
    num_of_volumes += CountOf(Explained(volume, {pose}), ModeOrigin::kTwistedPair) > 0;
  }
  EXPECT_GE(num_of_planes, 8);
  EXPECT_EQ(num_of_volumes, 0);
}

// A second body, a plane with two thirds of the matches of the first: its modes are looked at too, those of
// one with a third are not.
TEST(ExplainMatches, LooksAtModesOfHalfTheMatches) {
  for (const int num_second : {80, 40}) {
    int num_looked_at = 0;
    for (std::uint32_t trial = 0; trial < 6; ++trial) {
      RelativePose first, second;
      MotionProblem problem = SceneOf(120, false, trial, &first);
      const MotionProblem other = SceneOf(num_second, true, trial + 100, &second);
      problem.matches.insert(problem.matches.end(), other.matches.begin(), other.matches.end());
      num_looked_at += CountOf(Explained(problem, {first, second}), ModeOrigin::kTwistedPair) > 0;
    }
    if (num_second == 80)
      EXPECT_GE(num_looked_at, 4);
    else
      EXPECT_EQ(num_looked_at, 0);
  }
}

// One match on its epipolar line, of a point ten times nearer than all others: of many matches it is left out
// by its influence, of fewer than thirty none is, for there a large influence is nothing unusual.
TEST(ExplainMatches, LeavesOutByInfluenceAmongManyMatchesAlone) {
  for (const int num_matches : {100, 24}) {
    int num_left_out = 0;
    for (std::uint32_t trial = 0; trial < 40; ++trial) {
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2821});
      RandomProblem random =
          MakeRandomProblem(rng, {.num_matches = num_matches, .min_depth = 40.0, .max_depth = 80.0});
      AddNoise(0.5, rng, &random.problem);
      const Eigen::Vector3d ray = random.points_in_cam1[13] / random.points_in_cam1[13].z();
      random.problem.matches[13] =
          ProjectToBoth(4.0 * ray, random.pose_true, random.problem.camera1, random.problem.camera2);
      const MatchBlocks matches(random.problem);
      const MixturePrior prior = PriorOf(random.problem);
      Mode mode = StartMode(matches, prior, random.pose_true);
      if (!FitMode(matches, prior, 50, &mode)) continue;
      const std::vector<ExplainedMode> modes =
          ExplainMatches(random.problem, matches, prior, CalibratedOptions(), {mode});
      ASSERT_FALSE(modes.empty());
      num_left_out += CountIn(modes.front().mode.used) < num_matches;
    }
    if (num_matches == 100)
      EXPECT_GE(num_left_out, 4);
    else
      EXPECT_EQ(num_left_out, 0);
  }
}

// Any motion through five matches explains them: such a mode is not kept.
TEST(ExplainMatches, KeepsModesOfMoreThanFiveMatches) {
  RelativePose pose;
  const MotionProblem problem = SceneOf(100, false, 3, &pose);
  const MatchBlocks matches(problem);
  const MixturePrior prior = PriorOf(problem);
  Mode mode = StartMode(matches, prior, {RotationFromVector({0.5, -0.4, 0.3}), Eigen::Vector3d::UnitX()});
  mode.mixture.scale = 1e-3;  // next to nothing is as near
  mode.inverse_hessian = 1e-12 * Matrix5d::Identity();
  ASSERT_LE(Explain(matches, mode).num_explained, 5);
  EXPECT_TRUE(ExplainMatches(problem, matches, prior, CalibratedOptions(), {mode}).empty());
}

}  // namespace
}  // namespace rcme
