// Which modes are added to those that the samples found, and which matches they leave out.
#include "estimator/calibrated/explain_matches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

int CountModes(const std::vector<ExplainedMode>& modes, ModeOrigin origin) {
  return static_cast<int>(
      std::ranges::count_if(modes, [&](const ExplainedMode& m) { return m.mode.origin == origin; }));
}

// Points of a plane in front of camera 1, or anywhere between 4 and 16 baselines, seen with noise.
MotionProblem MakeSceneProblem(int num_matches, bool is_plane, std::uint32_t trial, RelativePose* pose_true) {
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
  const MixturePrior prior = MakePrior(problem);
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
    const MotionProblem plane = MakeSceneProblem(100, true, trial, &pose);
    num_of_planes += CountModes(Explained(plane, {pose}), ModeOrigin::kTwistedPair) > 0;
    const MotionProblem volume = MakeSceneProblem(100, false, trial, &pose);
    num_of_volumes += CountModes(Explained(volume, {pose}), ModeOrigin::kTwistedPair) > 0;
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
      MotionProblem problem = MakeSceneProblem(120, false, trial, &first);
      const MotionProblem other = MakeSceneProblem(num_second, true, trial + 100, &second);
      problem.matches.insert(problem.matches.end(), other.matches.begin(), other.matches.end());
      num_looked_at += CountModes(Explained(problem, {first, second}), ModeOrigin::kTwistedPair) > 0;
    }
    if (num_second == 80)
      EXPECT_GE(num_looked_at, 4);
    else
      EXPECT_EQ(num_looked_at, 0);
  }
}

// Points 40 to 80 baselines deep, and match 13 on its epipolar line, of a point at `depth`.
RandomProblem WithNearMatch(int num_matches, double depth, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2821});
  RandomProblem random =
      MakeRandomProblem(rng, {.num_matches = num_matches, .min_depth = 40.0, .max_depth = 80.0});
  AddNoise(0.5, rng, &random.problem);
  const Eigen::Vector3d ray = random.points_in_cam1[13] / random.points_in_cam1[13].z();
  random.problem.matches[13] =
      ProjectToBoth(depth * ray, random.pose_true, random.problem.camera1, random.problem.camera2);
  return random;
}

// One match on its epipolar line, of a point ten times nearer than all others: of many matches it is left out
// by its influence, of fewer than thirty none is, for there a large influence is nothing unusual.
TEST(ExplainMatches, LeavesOutByInfluenceAmongManyMatchesAlone) {
  for (const int num_matches : {100, 24}) {
    int num_left_out = 0;
    for (std::uint32_t trial = 0; trial < 40; ++trial) {
      const RandomProblem random = WithNearMatch(num_matches, 4.0, trial);
      const MatchBlocks matches(random.problem);
      const MixturePrior prior = MakePrior(random.problem);
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
  const MotionProblem problem = MakeSceneProblem(100, false, 3, &pose);
  const MatchBlocks matches(problem);
  const MixturePrior prior = MakePrior(problem);
  Mode mode = StartMode(matches, prior, {RotationFromVector({0.5, -0.4, 0.3}), Eigen::Vector3d::UnitX()});
  mode.mixture.scale = 1e-3;  // next to nothing is as near
  mode.inverse_hessian = 1e-12 * Matrix5d::Identity();
  ASSERT_LE(Explain(matches, mode).num_explained, 5);
  EXPECT_TRUE(ExplainMatches(problem, matches, prior, CalibratedOptions(), {mode}).empty());
}

// Says of the mode that it owes its direction to match 13, whose leverage becomes 0.9; that of matches with a
// twentieth of its parallax becomes a few thousandths.
void OweToNearMatch(const MatchBlocks& matches, Mode* mode) {
  mode->inverse_hessian.setZero();
  mode->inverse_hessian.bottomRightCorner<2, 2>() = 1e-12 * Eigen::Matrix2d::Identity();
  mode->inverse_hessian *= 0.9 / Explain(matches, *mode).leverage[13];
}

// The influence of such a match shows that it is wrong, and the others determine the motion: from thirty
// explained matches on it is left out, of 24 it never is.
TEST(ExplainMatches, LeavesOutByInfluenceFromThirtyMatchesOn) {
  for (const int num_matches : {40, 24}) {
    int num_left_out = 0;
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      const RandomProblem random = WithNearMatch(num_matches, 2.0, 100 + trial);
      FittedMode f = FitFromTruth(random.problem, random.pose_true);
      if (!f.has_converged) continue;
      OweToNearMatch(f.matches, &f.mode);
      const std::vector<ExplainedMode> modes =
          ExplainMatches(f.problem, f.matches, f.prior, CalibratedOptions(), {f.mode});
      ASSERT_FALSE(modes.empty());
      num_left_out += !(modes.front().mode.used[1] >> 5 & 1);
    }
    if (num_matches == 40)
      EXPECT_GE(num_left_out, 12);
    else
      EXPECT_EQ(num_left_out, 0);
  }
}

// A wide mode of 200 matches that uses the near one and 20 of a second body. Without the near one its fit
// goes to that body, whose motion explains fewer than half as many: the mode stays as it was.
TEST(ExplainMatches, LeavesNothingOutWhereHalfTheMatchesWouldGo) {
  int num_kept = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RandomProblem random = WithNearMatch(220, 2.0, 200 + trial);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2822});
    const RelativePose second{RotationFromVector(0.05 * RandomDirection(rng)) * random.pose_true.R,
                              random.pose_true.t};
    for (size_t i = 200; i < 220; ++i)
      random.problem.matches[i] =
          ProjectToBoth(random.points_in_cam1[i], second, random.problem.camera1, random.problem.camera2);
    const MatchBlocks matches(random.problem);
    const MixturePrior prior = MakePrior(random.problem);
    Mode mode = StartMode(matches, prior, random.pose_true, 8.0), without = mode;
    std::fill_n(without.used.begin(), 25, std::uint8_t{0});  // the first 200
    mode.used = without.used;
    mode.used[1] = 1u << 5;  // match 13
    OweToNearMatch(matches, &mode);
    const int num_explained = Explain(matches, mode).num_explained;
    if (!FitMode(matches, prior, 8, &without) || 2 * Explain(matches, without).num_explained >= num_explained)
      continue;
    const std::vector<ExplainedMode> modes =
        ExplainMatches(random.problem, matches, prior, CalibratedOptions(), {mode});
    ASSERT_FALSE(modes.empty());
    EXPECT_EQ(modes.front().mode.used, mode.used) << trial;
    EXPECT_EQ(modes.front().mode.pose.R, mode.pose.R) << trial;
    ++num_kept;
  }
  EXPECT_GE(num_kept, 4);
}

}  // namespace
}  // namespace rcme
