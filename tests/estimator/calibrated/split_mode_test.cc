#include "estimator/calibrated/split_mode.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/calibrated/explanation.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

// 150 matches of one body and 80 of another that moves a little differently, and a mode that explains both at
// a noise level of its own.
struct SplitBodies {
  RelativePose first, second;
  FittedMode merged;
};
SplitBodies FitSplitBodies(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2792});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 230});
  const RelativePose first = random.pose_true;
  const RelativePose second{RotationFromVector(0.02 * RandomDirection(rng)) * first.R,
                            (first.t + 0.2 * RandomDirection(rng)).normalized()};
  for (size_t i = 150; i < random.points_in_cam1.size(); ++i) {
    random.problem.matches[i] =
        ProjectToBoth(random.points_in_cam1[i], second, random.problem.camera1, random.problem.camera2);
  }
  AddNoise(0.5, rng, &random.problem);
  SplitBodies two{first, second, FitFromTruth(random.problem, first)};
  // Begun wide, as a mode that samples of both bodies lead to.
  two.merged.mode.mixture.scale = 10.0;
  FitMode(two.merged.matches, two.merged.prior, 30, &two.merged.mode);
  return two;
}

TEST(SplitMode, FindsBothMotionsOfACompromise) {
  int num_wide = 0, num_split = 0, num_right = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const SplitBodies two = FitSplitBodies(trial);
    if (two.merged.mode.mixture.scale < 1.5) continue;
    ++num_wide;
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2793});
    const auto split =
        SplitMode(two.merged.problem, two.merged.matches, two.merged.prior, two.merged.mode, rng);
    if (!split) continue;
    ++num_split;
    // The one with more matches is the first body's.
    const bool is_swapped = CountIn(split->first.used) < CountIn(split->second.used);
    const Mode& more = is_swapped ? split->second : split->first;
    const Mode& fewer = is_swapped ? split->first : split->second;
    num_right += RotationAngleBetween(more.pose.R, two.first.R) < 0.01 &&
                 RotationAngleBetween(fewer.pose.R, two.second.R) < 0.01;
    EXPECT_LT(more.mixture.scale, 1.5) << trial;
  }
  EXPECT_GE(num_wide, 10);
  EXPECT_GE(num_split, num_wide * 8 / 10);
  EXPECT_GE(num_right, num_split * 8 / 10);
}

// One body whose noise is four times the assumed one: nothing to split.
TEST(SplitMode, LeavesAModeOfGreaterNoiseAlone) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const FittedMode f = FitScene(200, 2.0, 0.2, trial, 0.25);
    ASSERT_GT(f.mode.mixture.scale, 2.5);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2794});
    EXPECT_FALSE(SplitMode(f.problem, f.matches, f.prior, f.mode, rng)) << trial;
  }
}

TEST(SplitCompromise, PutsBothMotionsInPlaceOfTheCompromise) {
  int num_split = 0;
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const SplitBodies two = FitSplitBodies(trial);
    if (two.merged.mode.mixture.scale < 1.5) continue;
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2795});
    Mode narrow = two.merged.mode;
    narrow.mixture.scale = 0.5;
    std::vector<Mode> modes = {two.merged.mode, narrow};
    SplitCompromise(two.merged.problem, two.merged.matches, two.merged.prior, &modes, rng);
    if (modes.size() == 2) continue;  // not split: as they were
    ++num_split;
    ASSERT_EQ(modes.size(), 3U);
    EXPECT_EQ(modes[0].mixture.scale, 0.5) << "the narrow one stays";
    EXPECT_LT(modes[1].mixture.scale, 1.5);
    EXPECT_LT(modes[2].mixture.scale, 1.5);
  }
  EXPECT_GE(num_split, 4);
}

TEST(SplitCompromise, LeavesNoModeAndModesOfTheAssumedNoiseAsTheyAre) {
  const FittedMode f = FitScene(100, 0.5, 0.2, 1);
  RandomStream rng({.seed = 1, .purpose = 2796});
  std::vector<Mode> modes;
  SplitCompromise(f.problem, f.matches, f.prior, &modes, rng);
  EXPECT_TRUE(modes.empty());
  modes = {f.mode};
  SplitCompromise(f.problem, f.matches, f.prior, &modes, rng);
  ASSERT_EQ(modes.size(), 1U);
  EXPECT_EQ(modes[0].pose.t, f.mode.pose.t);
}

// Beside 100 matches of one body 40 of another are a second motion, eight are not, even where two motions are
// far more likely than the mode.
TEST(SplitMode, NeedsADozenMatchesOfTheSecondMotion) {
  for (const int num_second : {40, 8}) {
    int num_split = 0;
    for (std::uint32_t trial = 0; trial < 8; ++trial) {
      RelativePose pose;
      MotionProblem problem = TwoCameraProblem(100, 0.5, 0.0, trial, &pose);
      const MotionProblem other = TwoCameraProblem(num_second, 0.5, 0.0, trial + 1000);
      problem.matches.insert(problem.matches.end(), other.matches.begin(), other.matches.end());
      FittedMode f = FitFromTruth(problem, pose);
      f.mode.log_likelihood = -1e9;
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2798});
      num_split += SplitMode(f.problem, f.matches, f.prior, f.mode, rng).has_value();
    }
    if (num_second == 40)
      EXPECT_GE(num_split, 5);
    else
      EXPECT_EQ(num_split, 0);
  }
}

}  // namespace
}  // namespace rcme
