#include "experiments/real/truth_free/size_test.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "estimator/robust_covariance/clustered_covariance.h"
#include "tests/test_support/fit_all_matches.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Noise of each match that grows as its stated scale, from e^-spread to e^spread, to the power `power`.
Answered MakePair(double power, double spread, int num_matches, std::uint32_t trial) {
  RelativePose pose;
  Answered answered;
  MotionProblem& problem = answered.pair.problem;
  problem = TwoCameraProblem(num_matches, 1e-9, 0.0, trial, &pose);
  problem.sigma_px = 0.5;
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 76});
  for (Correspondence& match : problem.matches) {
    problem.noise_scale.push_back(std::exp(rng.Uniform(-spread, spread)));
    AddNoise(0.3 * std::pow(problem.noise_scale.back(), power), rng, &match);
  }
  answered.estimate = FitAllMatches(problem, pose);
  return answered;
}

// Sum (x - mean x) y, x = log w^2, y = log (r^2 / (1 - h)), h the diagonal of J (J'J)^-1 J'.
TEST(SlopeScore, IsTheSumWrittenOut) {
  const Answered pair = MakePair(1.0, 1.0, 40, 1);
  MotionProblem unscaled = pair.pair.problem;
  unscaled.noise_scale.clear();
  unscaled.sigma_px = 1.0;
  const MatchScores scores = ScoreFitted(unscaled, pair.estimate.inliers, pair.estimate.cam2_from_cam1);
  Eigen::MatrixXd J(40, 5);
  for (int i = 0; i < 40; ++i) J.row(i) = scores.rows[static_cast<size_t>(i)].transpose();
  const Eigen::MatrixXd hat = J * (J.transpose() * J).ldlt().solve(J.transpose());
  Eigen::VectorXd x(40), y(40);
  for (Eigen::Index i = 0; i < 40; ++i) {
    const double r = scores.residuals[static_cast<size_t>(i)];
    x(i) = std::log(std::pow(pair.pair.problem.noise_scale[static_cast<size_t>(i)], 2));
    y(i) = std::log(r * r / (1.0 - hat(i, i)));
  }
  EXPECT_NEAR(SlopeScore(pair.pair.problem, pair.estimate), (x.array() - x.mean()).matrix().dot(y), 1e-8);
}

TEST(SlopeScore, NeedsScalesThatDifferAndTwentyInliers) {
  EXPECT_TRUE(
      std::isnan(SlopeScore(MakePair(1.0, 1.0, 19, 1).pair.problem, MakePair(1.0, 1.0, 19, 1).estimate)));
  Answered pair = MakePair(1.0, 1.0, 20, 1);
  EXPECT_TRUE(std::isfinite(SlopeScore(pair.pair.problem, pair.estimate)));
  // A spread of log w^2 whose mean square is below 0.01 says nothing.
  pair = MakePair(1.0, 0.02, 40, 1);
  EXPECT_TRUE(std::isnan(SlopeScore(pair.pair.problem, pair.estimate)));
  pair.pair.problem.noise_scale.clear();
  EXPECT_TRUE(std::isnan(SlopeScore(pair.pair.problem, pair.estimate)));
}

// The slope is the ratio of the sums over pairs and over the means of their twins.
TEST(TestKeyPointSizes, IsTheRatioToTheTwins) {
  std::vector<PairAnswers> answers;
  double sum = 0.0, of_twins = 0.0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    PairAnswers one{MakePair(0.5, 1.0, 60, i),
                    {MakePair(1.0, 1.0, 60, 100 + i), MakePair(1.0, 1.0, 60, 200 + i)}};
    sum += SlopeScore(one.whole.pair.problem, one.whole.estimate);
    for (const Answered& twin : one.twins) of_twins += 0.5 * SlopeScore(twin.pair.problem, twin.estimate);
    answers.push_back(std::move(one));
  }
  EXPECT_NEAR(TestKeyPointSizes(answers).slope.value, sum / of_twins, 1e-9);
  answers[3].whole.estimate.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(TestKeyPointSizes(answers).num_pairs, 7);
  for (Answered& twin : answers[4].twins) twin.estimate.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(TestKeyPointSizes(answers).num_pairs, 6);
}

// Of 24 pairs of 200 matches: noise as stated holds, noise that does not depend on the scale is too small a
// slope (its standard deviation is about 0.05: power by many of them).
TEST(TestKeyPointSizes, HoldsWhereTheNoiseIsAsStated) {
  for (const double power : {1.0, 0.0}) {
    std::vector<PairAnswers> answers;
    for (std::uint32_t i = 0; i < 24; ++i)
      answers.push_back({MakePair(power, 1.0, 200, i), {MakePair(1.0, 1.0, 200, 100 + i)}});
    EXPECT_EQ(TestKeyPointSizes(answers).verdict,
              power == 1.0 ? TruthFreeVerdict::kHolds : TruthFreeVerdict::kTooSmall);
  }
}

}  // namespace
}  // namespace rcme
