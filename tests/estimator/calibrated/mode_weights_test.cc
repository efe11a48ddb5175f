#include "estimator/calibrated/mode_weights.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "estimator/calibrated/fitted_constants.h"
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

// {exclusive, shared, explained, noise, width, forward, axial, turn}
using Terms = std::array<double, kNumModeTerms>;

void ExpectTerms(const Terms& found, const Terms& expected) {
  for (size_t k = 0; k < kNumModeTerms; ++k) EXPECT_NEAR(found[k], expected[k], 1e-12) << kModeTermNames[k];
}

TEST(ComputeModeTerms, OfExamplesByHand) {
  const ModeTraits usual = {100, 1.0, 2.0, 0.5, 0.05};
  ExpectTerms(ComputeModeTerms(Of(9.0, 0.0, 0.0), usual, usual), {3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  ExpectTerms(ComputeModeTerms(Of(-9.0, 0.0, 0.0), usual, usual), {-3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  ExpectTerms(ComputeModeTerms(Of(0.0, 20.0, 6.0), usual, usual), {0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0});
  ExpectTerms(ComputeModeTerms({}, {50, 0.5, 2.0, 0.96, 0.15}, usual),
              {0.0, 0.0, std::log(0.5), std::log(0.5), 0.0, 0.46, 0.2, std::log(2.0)});
  ExpectTerms(ComputeModeTerms({}, {100, 1.0, 2.0, 0.95, 0.0}, usual),
              {0.0, 0.0, 0.0, 0.0, 0.0, 0.45, 0.0, -std::log(2.0)});
  // 1 + 90 / 10 = 10 for the mean of 80 and 100 matches, of which the wider mode explains fewer.
  ExpectTerms(ComputeModeTerms({}, {80, 1.0, -38.0, 0.5, 0.05}, usual),
              {0.0, 0.0, std::log(0.8), 0.0, 2.0, 0.0, 0.0, 0.0});
}

TEST(ComputeModeTerms, HaveTheOtherSignTheOtherWayRound) {
  const ModeTraits a = {70, 0.7, 2.0, 0.99, 0.3}, b = {90, 1.1, 5.0, 0.2, 0.1};
  const Terms forth = ComputeModeTerms(Of(4.0, 7.0, 3.0), a, b);
  Terms back = ComputeModeTerms(Of(-4.0, -7.0, 3.0), b, a);
  for (double& x : back) x = -x;
  ExpectTerms(forth, back);
}

TEST(ComputeForwardness, IsTheMeanCosineToBothAxes) {
  const RelativePose along{RotationFromVector({0.0, 0.3, 0.0}), Eigen::Vector3d::UnitZ()};
  EXPECT_NEAR(ComputeForwardness(along), 0.5 * (1.0 + std::cos(0.3)), 1e-12);
  EXPECT_NEAR(ComputeForwardness({along.R, -along.t}), ComputeForwardness(along), 1e-12);
  EXPECT_NEAR(ComputeForwardness({along.R.transpose(), -along.R.transpose() * along.t}),
              ComputeForwardness(along), 1e-12);
  EXPECT_NEAR(ComputeForwardness({Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitY()}), 0.0, 1e-12);
}

// What speaks for a mode does so by its sign: more evidence, more matches, less noise, a greater width,
// travel along the axis or across it, a smaller rotation.
TEST(ModeLogOdds, GrowWithWhatSpeaksForTheMode) {
  const ModeTraits usual = {100, 1.0, 2.0, 0.7, 0.1};
  EXPECT_EQ(ModeLogOdds({}, usual, usual), 0.0);
  EXPECT_GT(ModeLogOdds(Of(9.0, 0.0, 0.0), usual, usual), 0.0);
  EXPECT_GT(ModeLogOdds(Of(0.0, 9.0, 0.0), usual, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {110, 1.0, 2.0, 0.7, 0.1}, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {100, 0.9, 2.0, 0.7, 0.1}, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {100, 1.0, 1.0, 0.7, 0.1}, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {100, 1.0, 2.0, 1.0, 0.1}, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {100, 1.0, 2.0, 0.0, 0.1}, usual), 0.0);
  EXPECT_GT(ModeLogOdds({}, {100, 1.0, 2.0, 0.7, 0.0}, usual), 0.0);
}

TEST(ModeLogOdds, AreTheFittedSumOfTheTerms) {
  const ModeTraits a = {70, 0.7, 2.0, 0.99, 0.3}, b = {90, 1.1, 5.0, 0.2, 0.1};
  const Contrast contrast = Of(4.0, 7.0, 3.0);
  const Terms terms = ComputeModeTerms(contrast, a, b);
  double sum = 0.0;
  for (size_t k = 0; k < kNumModeTerms; ++k) {
    EXPECT_STREQ(kModeTerms[k].name, kModeTermNames[k]);
    sum += kModeTerms[k].weight * terms[k];
  }
  EXPECT_NEAR(ModeLogOdds(contrast, a, b), sum, 1e-12);
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

TEST(SecondMotion, TermsAreAntisymmetric) {
  const MotionSupport a{50, 100.0}, b{100, 200.0};
  const auto of_a = ComputeSecondMotionTerms(a, b), of_b = ComputeSecondMotionTerms(b, a);
  EXPECT_NEAR(of_a[0], std::log(0.5), 1e-12);
  EXPECT_NEAR(of_a[1], std::log(0.5), 1e-12);
  for (size_t k = 0; k < of_a.size(); ++k) EXPECT_EQ(of_a[k], -of_b[k]);
  EXPECT_EQ(ComputeSecondMotionTerms({50, 1e9}, {50, 1.0})[1], 1.5) << "no more than that";
  EXPECT_EQ(ComputeSecondMotionTerms({50, 0.0}, {50, 1.0})[1], 0.0) << "matches on a line";
  EXPECT_EQ(ComputeSecondMotionTerms({0, 1.0}, {1, 1.0})[0], 0.0) << "no number below one";
}

TEST(SecondMotion, HasTheOddsOfItsNumberAndExtent) {
  const double number = kSecondMotionTerms[0].weight, extent = kSecondMotionTerms[1].weight;
  EXPECT_GT(number, 0.0);
  EXPECT_GT(extent, 0.0);
  EXPECT_NEAR(SecondMotionLogOdds(0.6, {50, 10.0}, {50, 10.0}), std::log(0.6), 1e-12);
  EXPECT_NEAR(SecondMotionLogOdds(0.6, {100, 10.0}, {50, 20.0}),
              std::log(0.6) + (extent - number) * std::log(2.0), 1e-12);
  EXPECT_EQ(std::exp(SecondMotionLogOdds(0.0, {100}, {50})), 0.0);
  EXPECT_EQ(std::exp(SecondMotionLogOdds(0.6, {100}, {0})), 0.0);
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
