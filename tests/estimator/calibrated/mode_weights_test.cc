#include "estimator/calibrated/mode_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

Contrast Of(double exclusive, double shared, double variance) {
  Contrast contrast;
  contrast.exclusive = exclusive;
  contrast.shared = shared;
  contrast.shared_variance = variance;
  return contrast;
}

TEST(ModeLogOdds, OfExamplesByHand) {
  EXPECT_NEAR(ModeLogOdds(Of(10.0, 0.0, 0.0), 0.0, 100.0), 2.6, 1e-12);
  // sd = 4: 20 is 8 beyond three of them and 5 of them.
  EXPECT_NEAR(ModeLogOdds(Of(0.0, 20.0, 6.0), 0.0, 100.0), 0.26 * 8.0 + 1.25 * 5.0, 1e-12);
  EXPECT_NEAR(ModeLogOdds(Of(0.0, -20.0, 6.0), 0.0, 100.0), -0.26 * 8.0 - 1.25 * 5.0, 1e-12);
  EXPECT_NEAR(ModeLogOdds(Of(0.0, 4.0, 6.0), 0.0, 100.0), 1.25, 1e-12);
  // Half the width counts at 50 matches, five nats at most.
  EXPECT_NEAR(ModeLogOdds(Of(0.0, 0.0, 0.0), 2.0, 50.0), 0.75, 1e-12);
  EXPECT_NEAR(ModeLogOdds(Of(0.0, 0.0, 0.0), 80.0, 50.0), 1.875, 1e-12);
  EXPECT_NEAR(ModeLogOdds(Of(0.0, 0.0, 0.0), -80.0, 50.0), -1.875, 1e-12);
}

TEST(EvidenceOfMotion, IsThatOfTheMatchesLessTheSearch) {
  MixtureParameters mixture;
  mixture.inlier_ratio = 0.5;
  Explanation mode;
  EXPECT_DOUBLE_EQ(EvidenceOfMotion(mode, mixture, 1e-3), -kSearchNats);
  mode.left_out_density.assign(10, 0.101);
  EXPECT_NEAR(EvidenceOfMotion(mode, mixture, 1e-3), 10.0 * std::log(51.0) - kSearchNats, 1e-12);
  mode.left_out_density.assign(10, 1e-3);
  EXPECT_NEAR(EvidenceOfMotion(mode, mixture, 1e-3), -kSearchNats, 1e-12);
}

TEST(SecondMotion, NeedsADozenClearMatchesOnEitherSide) {
  Contrast contrast;
  contrast.num_clearly_a = contrast.num_clearly_b = 12;
  EXPECT_TRUE(IsSecondMotion(contrast));
  contrast.num_clearly_b = 11;
  EXPECT_FALSE(IsSecondMotion(contrast));
  std::swap(contrast.num_clearly_a, contrast.num_clearly_b);
  EXPECT_FALSE(IsSecondMotion(contrast));
}

TEST(SecondMotion, HasThePriorOfItsShare) {
  EXPECT_NEAR(SecondMotionLogOdds(0.6, 50, 50), std::log(0.6), 1e-12);
  EXPECT_NEAR(SecondMotionLogOdds(0.6, 100, 50), std::log(0.6 / 8.0), 1e-12);
  EXPECT_EQ(std::exp(SecondMotionLogOdds(0.0, 100, 50)), 0.0);
  EXPECT_EQ(std::exp(SecondMotionLogOdds(0.6, 100, 0)), 0.0);
}

// Of the matches of two bodies: each motion fitted from its own, over all matches.
struct TwoBodies {
  FittedMode first, second;
};
TwoBodies FitTwoBodies(int num_first, int num_second, std::uint32_t trial) {
  RelativePose pose_first, pose_second;
  MotionProblem problem = TwoCameraProblem(num_first, 0.5, 0.0, trial, &pose_first);
  const MotionProblem other = TwoCameraProblem(num_second, 0.5, 0.0, trial + 1000, &pose_second);
  problem.matches.insert(problem.matches.end(), other.matches.begin(), other.matches.end());
  return {FitFromTruth(problem, pose_first), FitFromTruth(problem, pose_second)};
}

bool IsSecondMotion(const TwoBodies& two) {
  const double background =
      std::max(two.first.mode.mixture.outlier_density, two.second.mode.mixture.outlier_density);
  return IsSecondMotion(CompareModes(Explain(two.first.matches, two.first.mode),
                                     Explain(two.second.matches, two.second.mode), background));
}

TEST(SecondMotion, APlantedObjectIsOne) {
  int num_found = 0;
  for (std::uint32_t trial = 0; trial < 10; ++trial)
    num_found += IsSecondMotion(FitTwoBodies(150, 80, trial));
  EXPECT_GE(num_found, 9);
}

TEST(SecondMotion, AnyMotionOfOneBodyIsNone) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const FittedMode right = FitScene(200, 0.5, 0.3, trial);
    const FittedMode wrong = FitFromTruth(right.problem, FitScene(20, 0.5, 0.0, trial + 1000).pose_true);
    EXPECT_FALSE(IsSecondMotion({right, wrong})) << trial;
  }
}

}  // namespace
}  // namespace rcme
