#include "estimator/calibrated/candidates.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "estimator/calibrated/failure_probability.h"
#include "estimator/geometry/essential_matrix.h"
#include "tests/test_support/calibrated_mode.h"
#include "tests/test_support/street_scenes.h"

namespace rcme {
namespace {

TEST(PoseInFront, IsTheTruePoseOfTheTrueE) {
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    RelativePose pose_true;
    const MotionProblem problem = TwoCameraProblem(100, 0.5, 0.3, trial, &pose_true);
    for (const double sign : {1.0, -1.0}) {
      const RelativePose pose = PoseInFront(MatchBlocks(problem), sign * EssentialFromPose(pose_true));
      EXPECT_LT(LocalCoordinates(pose_true, pose).norm(), 1e-6) << trial;
    }
  }
}

TEST(IsSameMode, CountsStandardDeviationsOfTheFirst) {
  const FittedMode f = FitScene(100, 0.5, 0.2, 1);
  const Matrix5d root = f.mode.inverse_hessian.llt().matrixL();
  for (int k = 0; k < 5; ++k) {
    Mode beside = f.mode;
    beside.pose = Retract(f.mode.pose, 4.9 * root.col(k));
    EXPECT_TRUE(IsSameMode(f.mode, beside));
    EXPECT_FALSE(IsSameMode(f.mode, beside, 4.8));
    beside.pose = Retract(f.mode.pose, 5.1 * root.col(k));
    EXPECT_FALSE(IsSameMode(f.mode, beside));
  }
}

TEST(FindModes, TheFirstIsAsLikelyAsTheFitFromTheTruth) {
  for (const double factor : {0.25, 1.0, 4.0}) {
    for (std::uint32_t trial = 0; trial < 10; ++trial) {
      const FittedMode f = FitScene(200, 0.5, 0.4, trial, factor);
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 2755});
      const HypothesisSearch search = SearchHypotheses(f.matches, ScoreMatches(f.matches), {}, rng);
      const std::vector<Mode> modes = FindModes(f.matches, f.prior, search.candidates, 6);
      ASSERT_FALSE(modes.empty());
      EXPECT_LE(modes.size(), 6U);
      EXPECT_GT(modes.front().log_likelihood, f.mode.log_likelihood - 0.1) << factor << " " << trial;
      for (size_t i = 1; i < modes.size(); ++i) {
        EXPECT_LE(modes[i].log_likelihood, modes[i - 1].log_likelihood);
        for (size_t k = 0; k < i; ++k) EXPECT_FALSE(IsSameMode(modes[k], modes[i]));
      }
    }
  }
}

// Half of the points are so far away that they have no parallax. With noise they lie behind the cameras as
// often as before them, so that the cheirality c(z) rejects nearly every step of some fits.
TEST(FindModes, TheMotionIsFoundAmongPointsWithoutParallax) {
  constexpr int kScenes = 400;
  int num_found = 0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial) {
    Scene scene = TwoCameraScene(300, trial);
    for (size_t i = 0; i < scene.points_in_cam1.size(); i += 2) scene.points_in_cam1[i] *= 1e4;
    const MotionProblem problem = {ObserveTwoCameraScene(scene, 0.5, 0.2, trial).matches, scene.camera1,
                                   scene.camera2, 0.5};
    const MatchBlocks matches(problem);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2756});
    const HypothesisSearch search = SearchHypotheses(matches, ScoreMatches(matches), {}, rng);
    const std::vector<Mode> modes = FindModes(matches, MakePrior(problem), search.candidates, 8);
    num_found += std::ranges::any_of(modes, [&](const Mode& mode) {
      return IsWithin(mode.pose, {0.05, 0.25}, scene.cam2_from_cam1_true);
    });
  }
  EXPECT_GE(num_found, kScenes - 4);
}

// Where the parallax is below the wide scale, the few steps at that scale lead away from good candidates.
TEST(FindModes, TheMotionIsFoundOnAStreetOfLittleParallax) {
  const StreetScenes scenes;
  constexpr int kScenes = 60;
  int num_found = 0;
  for (std::uint32_t trial = 0; trial < kScenes; ++trial) {
    const StreetScenes::Case street = scenes.Make(trial);
    const MatchBlocks matches(street.problem);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2757});
    const HypothesisSearch search = SearchHypotheses(matches, ScoreMatches(matches), {}, rng);
    const std::vector<Mode> modes = FindModes(matches, MakePrior(street.problem), search.candidates, 4);
    num_found += std::ranges::any_of(modes, [&](const Mode& mode) {
      return IsWithin(mode.pose, {0.05, 0.25}, street.pose_true);
    });
  }

  EXPECT_GE(num_found, kScenes * 3 / 4);
}

TEST(FindModes, OfNoCandidateThereAreNone) {
  const FittedMode f = FitScene(20, 0.5, 0.0, 1);
  EXPECT_TRUE(FindModes(f.matches, f.prior, {}, 6).empty());
}

// From the truth the optimum is the fit's, found once however often it is begun there; its scale is what is
// known, or what is estimated.
TEST(ModesFrom, ReachesEachOptimumOnce) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const FittedMode f = FitScene(200, 0.5, 0.3, trial);
    const std::vector<Mode> modes = ModesFrom(f.matches, f.prior, {f.pose_true, f.mode.pose, f.pose_true});
    ASSERT_EQ(modes.size(), 1u) << trial;
    EXPECT_TRUE(IsSameMode(modes[0], f.mode, 0.1));
    EXPECT_NEAR(modes[0].mixture.scale / f.mode.mixture.scale, 1.0, 0.02);
    const std::vector<Mode> known = ModesFrom(f.matches, {f.prior.uniform_density, false}, {f.pose_true});
    ASSERT_EQ(known.size(), 1u);
    EXPECT_EQ(known[0].mixture.scale, NoiseLaw().scale_of_gaussian);
  }
}

// Two bodies, the assumed noise that of the way between their motions: from the assumed scale a fit ends in a
// compromise, from the scale that suits the first matches at one of the two. Both are optima, of one motion
// within the width of the wider, and told apart by their scales. Where the noise is known there is but one.
TEST(ModesFrom, BeginsAtTheScaleThatSuitsToo) {
  int num_both = 0;
  for (std::uint32_t trial = 0; trial < 12; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 2756});
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 240});
    const RelativePose second{RotationFromVector(0.006 * RandomDirection(rng)) * random.pose_true.R,
                              (random.pose_true.t + 0.1 * RandomDirection(rng)).normalized()};
    for (size_t i = 0; i < 240; i += 3) {
      random.problem.matches[i] =
          ProjectToBoth(random.points_in_cam1[i], second, random.problem.camera1, random.problem.camera2);
    }
    AddNoise(0.25, rng, &random.problem);
    random.problem.sigma_px = 1.5;
    const MatchBlocks matches(random.problem);
    const MixturePrior prior = MakePrior(random.problem);
    const std::vector<Mode> modes = ModesFrom(matches, prior, {random.pose_true});
    num_both += modes.size() == 2 && modes[1].mixture.scale < 0.5 * modes[0].mixture.scale;
    EXPECT_LE(ModesFrom(matches, {prior.uniform_density, false}, {random.pose_true}).size(), 1u);
  }
  EXPECT_GE(num_both, 4);
}

// 128 matches of a tenth of the assumed noise before 400 of eight times it, all of one motion. One optimum
// explains all of them, another at a far lesser scale the precise ones alone.
FittedMode FitTwoNoiseLevels(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2759});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 528});
  for (size_t i = 0; i < 528; ++i) AddNoise(i < 128 ? 0.05 : 4.0, rng, &random.problem.matches[i]);
  random.problem.sigma_px = 0.5;
  return FitFromTruth(random.problem, random.pose_true);
}

// Of the scales tried, those of Gaussian noise at 1/4, 1/2, ..., 8 times the assumed sigma, the least suits
// the first 128 matches: the second optimum is where the same 18 steps from there end. From a scale beside
// it, such as 1/4 itself, they end elsewhere by 1e-4 of it.
TEST(ModesFrom, BeginsAtAQuarterOfTheAssumedNoiseWhereThatSuits) {
  int num_both = 0;
  for (std::uint32_t trial = 0; trial < 6; ++trial) {
    const FittedMode f = FitTwoNoiseLevels(trial);
    const std::vector<Mode> modes = ModesFrom(f.matches, f.prior, {f.pose_true});
    if (modes.size() != 2) continue;
    ++num_both;
    Mode from_quarter = StartMode(f.matches, f.prior, f.pose_true);
    from_quarter.mixture = FirstGuess(f.prior, 0.25 * NoiseLaw().scale_of_gaussian, 0.5);
    ASSERT_TRUE(FitMode(f.matches, f.prior, 18, &from_quarter));
    EXPECT_LT(modes[1].mixture.scale, 0.5 * modes[0].mixture.scale);
    EXPECT_NEAR(modes[1].mixture.scale, from_quarter.mixture.scale, 1e-9) << trial;
  }
  EXPECT_GE(num_both, 4);
}

// The lesser optimum lies within the width of the likelier one, that of all matches: of the two it returns
// that one.
TEST(FindModes, ReturnsOneModeOfAMotionAtTwoScales) {
  int num_one = 0;
  for (std::uint32_t trial = 0; trial < 6; ++trial) {
    const FittedMode f = FitTwoNoiseLevels(trial);
    const ScoredEssential candidate{EssentialFromPose(f.pose_true), 300.0};
    const std::vector<Mode> modes = FindModes(f.matches, f.prior, {candidate}, 6);
    ASSERT_FALSE(modes.empty());
    if (modes.size() == 1)
      ++num_one;
    else
      EXPECT_FALSE(IsSameMode(modes[0], modes[1])) << trial;
  }
  EXPECT_GE(num_one, 4);
}

}  // namespace
}  // namespace rcme
