#include "estimator/kernels/match_blocks.h"

#include <gtest/gtest.h>

#include <numeric>

#include "estimator/geometry/sampson.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

RandomProblem MakeProblem(int num_matches, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2600});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.3, rng, &random.problem);
  return random;
}

TEST(MatchBlocks, HoldWhitenedCoordinatesAndZerosBeyondTheLastMatch) {
  for (int n = 0; n <= 17; ++n) {
    const MotionProblem problem = MakeProblem(n, static_cast<std::uint32_t>(n)).problem;
    const MatchBlocks matches(problem);
    ASSERT_EQ(matches.num_matches(), n);
    ASSERT_EQ(matches.num_blocks(), (n + 7) / 8);
    for (int i = 0; i < 8 * matches.num_blocks(); ++i) {
      const MatchBlock& block = matches[i / 8];
      const Eigen::Vector4d held(block.x1[i % 8], block.y1[i % 8], block.x2[i % 8], block.y2[i % 8]);
      if (i >= n) {
        EXPECT_EQ(held, Eigen::Vector4d::Zero()) << "lane " << i << " of " << n;
        continue;
      }
      // What it must undo, by the cameras' own formulas.
      const Correspondence& match = problem.matches[static_cast<size_t>(i)];
      const Eigen::Vector3d ray1(matches.ray_scale().x1 * held(0), matches.ray_scale().y1 * held(1), 1.0);
      const Eigen::Vector3d ray2(matches.ray_scale().x2 * held(2), matches.ray_scale().y2 * held(3), 1.0);
      EXPECT_LT((ray1 - problem.camera1.Ray(match.x1_px)).norm(), 1e-14);
      EXPECT_LT((ray2 - problem.camera2.Ray(match.x2_px)).norm(), 1e-14);
      const Eigen::Vector2d moved = problem.camera2.Project(
          Eigen::Vector3d(matches.ray_scale().x2 * (held(2) + 1.0), matches.ray_scale().y2 * held(3), 1.0));
      EXPECT_NEAR((moved - match.x2_px).norm(), problem.sigma_px, 1e-11) << "one unit is one sigma";
    }
  }
}

TEST(MatchBlocks, FundamentalGivesTheConstraintOfTheRaysInUnitsOfSigma) {
  const RandomProblem random = MakeProblem(20, 100);
  const MotionProblem& problem = random.problem;
  const MatchBlocks matches(problem);
  const Eigen::Matrix3d E = EssentialFromPose(random.pose_true);
  const Eigen::Matrix3d F_whitened = matches.FundamentalFromEssential(E);
  const Eigen::Matrix3d F = FundamentalFromEssential(E, problem.camera1, problem.camera2);
  for (int i = 0; i < 20; ++i) {
    const MatchBlock& block = matches[i / 8];
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const Correspondence whitened{{block.x1[i % 8], block.y1[i % 8]}, {block.x2[i % 8], block.y2[i % 8]}};
    const EpipolarConstraint of_px = EvaluateConstraint(F, match),
                             ours = EvaluateConstraint(F_whitened, whitened);
    EXPECT_GT(std::abs(of_px.g), 1e-8) << "a match without residual tests nothing";
    EXPECT_NEAR(ours.g, of_px.g, 1e-14);
    EXPECT_LT((ours.gradient - problem.sigma_px * of_px.gradient).norm(), 1e-12 * ours.gradient.norm());
  }
}

TEST(MatchMask, GoesToIndicesAndBack) {
  RandomStream rng({.seed = 1, .purpose = 2601});
  for (int n = 0; n <= 33; ++n) {
    const MotionProblem problem = MakeProblem(n, 200).problem;
    const MatchBlocks matches(problem);
    std::vector<int> all(static_cast<size_t>(n)), some;
    std::iota(all.begin(), all.end(), 0);
    for (const int i : all) {
      if (rng.Uniform() < 0.4) some.push_back(i);
    }
    const MatchMask mask = MakeMask(some, matches);
    EXPECT_EQ(ListIndices(mask), some);
    EXPECT_EQ(CountIn(mask), static_cast<int>(some.size()));
    EXPECT_EQ(ListIndices(matches.All()), all) << "no lane beyond the last match";
    EXPECT_EQ(CountInBoth(mask, matches.All()), static_cast<int>(some.size()));
    EXPECT_EQ(CountInBoth(mask, matches.Empty()), 0);
    EXPECT_TRUE(ListIndices(matches.Empty()).empty());
  }
}

TEST(MatchMask, BitLOfByteBIsMatch8BPlusL) {
  const MotionProblem problem = MakeProblem(20, 201).problem;
  const MatchBlocks matches(problem);
  EXPECT_EQ(MakeMask(std::vector<int>{0, 9, 10, 19}, matches), (MatchMask{0x01, 0x06, 0x08}));
  EXPECT_EQ(CountInBoth({0x0f, 0xf0}, {0x3c, 0x30}), 4);
}

}  // namespace
}  // namespace rcme
