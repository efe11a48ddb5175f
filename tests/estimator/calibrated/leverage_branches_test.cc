// One wrong match near the cameras among far ones: alone it determines the direction.
#include "estimator/calibrated/leverage_branches.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/calibrated/candidates.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

struct Planted {
  FittedMode fitted;
  size_t index;  // of the match that was moved
};

// Points 60 to 100 baselines deep; match 13 is of a point at six, off its epipolar line by `off_px`.
Planted PlantMatch(std::uint32_t trial, double off_px) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2760});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 60, .min_depth = 60.0, .max_depth = 100.0});
  MotionProblem& problem = random.problem;
  AddNoise(0.5, rng, &problem);
  Correspondence& match = problem.matches[13];
  const Eigen::Vector3d ray = random.points_in_cam1[13] / random.points_in_cam1[13].z();
  match = ProjectToBoth(6.0 * ray, random.pose_true, problem.camera1, problem.camera2);
  const Eigen::Vector2d along =
      (match.x2_px - random.problem.camera2.Project(random.pose_true.R * random.points_in_cam1[13]))
          .normalized();
  match.x2_px += off_px * Eigen::Vector2d(-along.y(), along.x());
  return {FitFromTruth(problem, random.pose_true), 13};
}

TEST(LeverageBranches, LeaveOutTheMatchThatOwnsTheFit) {
  int num_owned = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    const Planted planted = PlantMatch(trial, 3.0);
    const FittedMode& f = planted.fitted;
    if (!f.has_converged) continue;
    const Explanation explanation = Explain(f.matches, f.mode);
    if (explanation.probability[planted.index] < 0.5) continue;  // seen to be wrong: nothing to branch on
    EXPECT_GT(explanation.leverage[planted.index], kLargeLeverage) << trial;
    const std::vector<Mode> branches = LeverageBranches(f.matches, f.prior, f.mode, explanation);
    const auto branch = std::ranges::find_if(
        branches, [](const Mode& b) { return !(b.used[1] >> 5 & 1) && CountIn(b.used) == 59; });
    if (branch == branches.end()) continue;  // the fit without it does not converge
    ++num_owned;
    EXPECT_EQ(branch->origin, ModeOrigin::kLeverage);
    EXPECT_FALSE(IsSameMode(*branch, f.mode, 1e-3)) << trial;
  }
  EXPECT_GE(num_owned, 30);
}

TEST(LeverageBranches, AreNoneWhereNoMatchIsInfluential) {
  const FittedMode f = FitScene(300, 0.5, 0.2, 1);
  Explanation explanation = Explain(f.matches, f.mode);
  ASSERT_LT(std::ranges::max(explanation.leverage), kLargeLeverage);
  EXPECT_TRUE(LeverageBranches(f.matches, f.prior, f.mode, explanation).empty());
  // Of five said to be influential the greatest three, each alone and all three together.
  for (size_t i = 0; i < 5; ++i) explanation.leverage[10 * i] = 0.3 + 0.1 * static_cast<double>(i);
  const std::vector<Mode> branches = LeverageBranches(f.matches, f.prior, f.mode, explanation);
  ASSERT_EQ(branches.size(), 4U);
  const auto misses = [&](size_t branch, int i) {
    return !(branches[branch].used[static_cast<size_t>(i / 8)] >> (i % 8) & 1);
  };
  for (size_t branch = 0; branch < 4; ++branch) {
    EXPECT_EQ(CountIn(branches[branch].used), branch < 3 ? 299 : 297);
    for (const size_t of : {size_t{0}, size_t{1}, size_t{2}}) {
      const bool is_without = branch == of || branch == 3;
      EXPECT_EQ(misses(branch, 40 - 10 * static_cast<int>(of)), is_without);
    }
  }
}

TEST(LeverageBranches, BeginAtALeverageOfAQuarter) {
  const FittedMode f = FitScene(60, 0.5, 0.0, 1);
  Explanation explanation = Explain(f.matches, f.mode);
  explanation.leverage.assign(60, 0.24);
  EXPECT_TRUE(LeverageBranches(f.matches, f.prior, f.mode, explanation).empty());
  explanation.leverage[17] = 0.26;
  const std::vector<Mode> branches = LeverageBranches(f.matches, f.prior, f.mode, explanation);
  ASSERT_EQ(branches.size(), 1U);
  EXPECT_FALSE(branches[0].used[2] >> 1 & 1);
  EXPECT_EQ(CountIn(branches[0].used), 59);
}

}  // namespace
}  // namespace rcme
