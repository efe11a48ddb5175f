#include "estimator/calibrated/noise_choice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

// 300 matches, no wrong ones, noise of standard deviation 0.5 px: Gaussian, or Student's with `dof` degrees
// of freedom.
FittedMode FitNoise(std::uint32_t trial, int dof) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2811});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 300});
  const auto draw = [&] {
    const double normal = rng.Normal();
    if (dof == 0) return 0.5 * normal;
    double chi2 = 0.0;
    for (int i = 0; i < dof; ++i) chi2 += std::pow(rng.Normal(), 2);
    return 0.5 * std::sqrt((dof - 2.0) / chi2) * normal;
  };
  for (Correspondence& match : random.problem.matches) {
    match.x1_px += Eigen::Vector2d(draw(), draw());
    match.x2_px += Eigen::Vector2d(draw(), draw());
  }
  random.problem.sigma_px = 0.5;
  return FitFromTruth(random.problem, random.pose_true);
}

// How often the law of fifteen degrees is chosen in 200 trials. What it says of sigma stays what it was.
int CountFifteen(int dof) {
  int count = 0;
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    const FittedMode fitted = FitNoise(trial, dof);
    ExplainedMode answer{fitted.mode, Explain(fitted.matches, fitted.mode)};
    ChooseNoiseLaw(fitted.matches, fitted.prior, &answer);
    const MixtureParameters &before = fitted.mode.mixture, &after = answer.mode.mixture;
    if (after.noise.power == before.noise.power) {
      EXPECT_EQ(answer.mode.pose.R, fitted.mode.pose.R);
      continue;
    }
    ++count;
    EXPECT_EQ(after.noise.power, kStudent15.power);
    EXPECT_GT(answer.mode.log_likelihood, fitted.mode.log_likelihood);
    EXPECT_EQ(answer.explanation.probability, Explain(fitted.matches, answer.mode).probability);
    EXPECT_NEAR(after.scale / after.noise.scale_of_gaussian, before.scale / before.noise.scale_of_gaussian,
                0.1);
  }
  return count;
}

// Per match the law of fifteen degrees gains .0155 nats in Gaussian noise (4.6 of 300), and loses in
// Student's noise of three.
TEST(NoiseChoice, FollowsTheTails) {
  EXPECT_GE(CountFifteen(0), 140);
  EXPECT_LE(CountFifteen(3), 20);
}

TEST(NoiseChoice, IsLeftAloneByAFewMatches) {
  const FittedMode fitted = FitScene(12, 0.5, 0.0, 3);
  ExplainedMode answer{fitted.mode, Explain(fitted.matches, fitted.mode)};
  ChooseNoiseLaw(fitted.matches, fitted.prior, &answer);
  EXPECT_EQ(answer.mode.mixture.noise.power, NoiseLaw().power) << "a gain of a fifth of a nat";
}

}  // namespace
}  // namespace rcme
