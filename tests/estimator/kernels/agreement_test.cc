// Agreement and cheirality against refinement/fit_set.h and geometry/triangulation.h, on every instruction
// set.
#include "estimator/kernels/agreement.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "estimator/geometry/triangulation.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/sampson_mle.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class AgreementTest : public OnEveryTarget {};

// Matches with noise, points at infinity among them, one in four wrong; a motion fitted to some of the
// others.
struct FittedProblem {
  MotionProblem problem;
  RelativePose pose_true;
  RefinedMotion motion;
  std::vector<int> fitted;
};

FittedProblem MakeFittedProblem(int num_matches, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2640});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  FittedProblem c;
  for (size_t i = 0; i < random.problem.matches.size(); ++i) {
    if (i % 5 == 1) {  // so far away that noise puts half of them behind the cameras
      random.problem.matches[i] = ProjectToBoth(1e5 * random.points_in_cam1[i], random.pose_true,
                                                random.problem.camera1, random.problem.camera2);
    }
  }
  AddNoise(0.5, rng, &random.problem);
  for (int i = 0; i < num_matches; ++i) {
    Correspondence& match = random.problem.matches[static_cast<size_t>(i)];
    if (i % 4 == 2) {
      match.x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
    } else if (rng.Uniform() < 0.7) {
      c.fitted.push_back(i);
    }
  }
  // Every third case says how noisy each match is.
  for (int i = 0; trial % 3 == 2 && i < num_matches; ++i)
    random.problem.noise_scale.push_back(rng.Uniform(0.5, 2.0));
  c.problem = random.problem;
  c.pose_true = random.pose_true;
  c.motion = RefineBySampson(c.problem, c.fitted, random.pose_true, Loss::kSquared);
  return c;
}

constexpr int kNumMatches[] = {12, 15, 16, 17, 40, 41, 200};

TEST_F(AgreementTest, FindsTheMatchesThatTheFitSetFinds) {
  int num_converged = 0, num_agreeing = 0, num_not = 0;
  for (const int n : kNumMatches) {
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const FittedProblem c = MakeFittedProblem(n, trial);
      // A fit to five matches has none to spare: every residual and its variance are zero, and rounding
      // decides.
      if (!c.motion.converged || c.fitted.size() <= 5) continue;
      ++num_converged;
      const std::vector<int> expected = FindAgreeing(c.problem, c.motion, c.fitted, 0.05);
      const std::vector<int> expected_fit = SelectFitSet(c.problem, c.motion, c.fitted);
      num_agreeing += static_cast<int>(expected.size());
      num_not += n - static_cast<int>(expected.size());
      Run([&] {
        const MatchBlocks matches(c.problem);
        const BlockMatches block(c.problem, matches, RefinementError::kSampson);
        const MatchMask fitted = MakeMask(c.fitted, matches);
        EXPECT_EQ(ListIndices(block.FindAgreeing(c.motion, fitted, 0.05)), expected)
            << n << ", trial " << trial;
        EXPECT_EQ(ListIndices(block.SelectFitSet(c.motion, fitted)), expected_fit)
            << n << ", trial " << trial;
      });
    }
  }
  EXPECT_GT(num_converged, 60);
  EXPECT_GT(num_agreeing, 1000);
  EXPECT_GT(num_not, 500);
}

TEST_F(AgreementTest, TheFitSetKnowsLeverageAndWhatWasFitted) {
  constexpr double kAlpha = 0.3;  // many matches near their thresholds
  // Cases in which these two matter; the test above would else not see them.
  int num_by_leverage = 0, num_by_being_fitted = 0, num_behind = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    const FittedProblem c = MakeFittedProblem(40, trial);
    const std::vector<int> agreeing = FindAgreeing(c.problem, c.motion, c.fitted, kAlpha);
    num_by_leverage += FindAgreeing(c.problem, c.motion, c.fitted, kFitSignificance) !=
                       SelectFitSet(c.problem, c.motion, c.fitted);
    num_by_being_fitted += agreeing != FindAgreeing(c.problem, c.motion, {}, kAlpha);
    RefinedMotion backwards = c.motion;
    backwards.cam2_from_cam1.t *= -1.0;
    const std::vector<int> behind = FindAgreeing(c.problem, backwards, c.fitted, kAlpha);
    num_behind += behind.size() < agreeing.size() && !behind.empty();  // what is at infinity stays
    Run([&] {
      const MatchBlocks matches(c.problem);
      const BlockMatches block(c.problem, matches, RefinementError::kSampson);
      EXPECT_EQ(ListIndices(block.FindAgreeing(c.motion, matches.Empty(), kAlpha)),
                FindAgreeing(c.problem, c.motion, {}, kAlpha));
      EXPECT_EQ(ListIndices(block.FindAgreeing(backwards, MakeMask(c.fitted, matches), kAlpha)), behind);
    });
  }
  EXPECT_GT(num_by_leverage, 0);
  EXPECT_GT(num_by_being_fitted, 3);
  EXPECT_GT(num_behind, 20);
}

TEST_F(AgreementTest, AnInvalidCovarianceAgreesWithNothing) {
  FittedProblem c = MakeFittedProblem(16, 0);
  c.motion.pose_cov(0, 0) = std::nan("");
  const MatchBlocks matches(c.problem);
  const BlockMatches block(c.problem, matches, RefinementError::kSampson);
  EXPECT_EQ(CountIn(block.FindAgreeing(c.motion, matches.Empty(), 0.05)), 0);
  EXPECT_TRUE(FindAgreeing(c.problem, c.motion, {}, 0.05).empty());
}

int CountFrontOneByOne(const FittedProblem& c, const RelativePose& pose) {
  return static_cast<int>(std::ranges::count_if(c.fitted, [&](int i) {
    const Correspondence& match = c.problem.matches[static_cast<size_t>(i)];
    return IsInFrontOfBothCameras(pose, c.problem.camera1.Ray(match.x1_px),
                                  c.problem.camera2.Ray(match.x2_px));
  }));
}

TEST_F(AgreementTest, CountsAsManyInFrontAsTheTriangulation) {
  for (const int n : kNumMatches) {
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const FittedProblem c = MakeFittedProblem(n, trial);
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2641});
      for (const RelativePose& pose : {c.pose_true, RandomPose(rng, 180.0), RandomPose(rng, 180.0)}) {
        const RelativePose opposite{pose.R, -pose.t};
        const int with_t = CountFrontOneByOne(c, pose), with_opposite_t = CountFrontOneByOne(c, opposite);
        Run([&] {
          const MatchBlocks matches(c.problem);
          const FrontCounts counts = CountInFront(matches, MakeMask(c.fitted, matches), pose);
          EXPECT_EQ(counts.with_t, with_t);
          EXPECT_EQ(counts.with_opposite_t, with_opposite_t);
        });
      }
      EXPECT_GT(CountFrontOneByOne(c, c.pose_true), 0);
    }
  }
}

TEST_F(AgreementTest, SelectsTheSamePoseOfTheFour) {
  std::array<int, 4> num_selected{};
  for (std::uint32_t trial = 0; trial < 60; ++trial) {
    const FittedProblem c = MakeFittedProblem(trial % 3 == 0 ? 12 : 40, trial);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2642});
    // The true motion, seen through one of its four; or any, where counts are small and ties happen.
    const RelativePose pose = trial % 2 == 0 ? c.pose_true : RandomPose(rng, 180.0);
    const EssentialProjection projection =
        ProjectToEssential(EssentialFromPose(pose) * (trial % 4 < 2 ? 1 : -1));
    const RelativePose expected =
        ReferenceMatches(c.problem, RefinementError::kSampson).SelectPose(projection, c.fitted);
    const auto poses = PosesFromEssential(projection);
    for (size_t k = 0; k < 4; ++k) num_selected[k] += poses[k].R == expected.R && poses[k].t == expected.t;
    Run([&] {
      const MatchBlocks matches(c.problem);
      const RelativePose selected = SelectPoseByCheirality(matches, MakeMask(c.fitted, matches), projection);
      EXPECT_EQ(selected.R, expected.R) << trial;
      EXPECT_EQ(selected.t, expected.t) << trial;
    });
  }
  for (const int count : num_selected) EXPECT_GT(count, 3);
}

TEST_F(AgreementTest, CountsTheConsistentMatchesOfTheReference) {
  for (const int n : kNumMatches) {
    const FittedProblem c = MakeFittedProblem(n, 70);
    const int expected =
        ReferenceMatches(c.problem, RefinementError::kSampson).CountConsistent(c.fitted, c.pose_true, 0.2);
    EXPECT_GT(expected, 0);
    EXPECT_LT(expected, static_cast<int>(c.fitted.size()));
    Run([&] {
      const MatchBlocks matches(c.problem);
      const BlockMatches block(c.problem, matches, RefinementError::kSampson);
      EXPECT_EQ(block.CountConsistent(MakeMask(c.fitted, matches), c.pose_true, 0.2), expected);
    });
  }
}

}  // namespace
}  // namespace rcme
