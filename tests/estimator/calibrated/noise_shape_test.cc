#include "estimator/calibrated/noise_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "tests/test_support/anisotropic_noise.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

// Travel along the axis, so that the epipolar lines have every direction; noise of 0.5 px.
FittedMode FitForward(std::uint32_t trial, const Eigen::Matrix2d& shape, int num_matches = 400) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2990});
  const RandomProblem random = ForwardProblem(num_matches, shape, rng);
  return FitFromTruth(random.problem, random.pose_true);
}
// Isotropic if there is no fit.
NoiseShape FitShape(const FittedMode& fitted) {
  return FitNoiseShape(fitted.problem, {fitted.mode, Explain(fitted.matches, fitted.mode)})
      .value_or(NoiseShape{});
}

// The means of 40 fits. The smallest of the shapes is seen in most of them, the other two in all.
TEST(FitNoiseShape, FindsTheRatioAndTheAxis) {
  for (const auto& [b, c] : {std::pair{0.8, 0.0}, {-0.4, 0.5}, {0.0, -0.8}}) {
    Eigen::Matrix2d shape;
    shape << 1.0 + b, c, c, 1.0 - b;
    double sum_b = 0.0, sum_c = 0.0;
    int num_seen = 0;
    constexpr int kTrials = 40;
    for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
      const NoiseShape found = FitShape(FitForward(trial, shape));
      num_seen += IsNoiseAnisotropic(found, {});
      EXPECT_TRUE(found.Covariance().llt().info() == Eigen::Success);
      sum_b += found.b;
      sum_c += found.c;
    }
    EXPECT_GE(num_seen, kTrials * 3 / 5) << b << " " << c;
    EXPECT_NEAR(sum_b / kTrials, b, 0.05);
    EXPECT_NEAR(sum_c / kTrials, c, 0.05);
  }
}

// A gain above 12 nats by chance has a probability of e^-12. A scale that is twice what the residuals say, as
// where sigma is assumed, is no shape.
TEST(FitNoiseShape, IsotropicNoiseIsIsotropic) {
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    FittedMode fitted = FitForward(trial, Eigen::Matrix2d::Identity());
    EXPECT_FALSE(IsNoiseAnisotropic(FitShape(fitted), {})) << trial;
    for (const double factor : {0.5, 2.0}) {
      FittedMode assumed = fitted;
      assumed.mode.mixture.scale *= factor;
      EXPECT_FALSE(IsNoiseAnisotropic(FitShape(assumed), {})) << trial << " " << factor;
    }
  }
}

// Of a thousand matches 512 are used; the gain of all is that of the used ones times 1000 / 512.
TEST(FitNoiseShape, TheGainOfAllIsInProportion) {
  const Eigen::Matrix2d shape = Eigen::Vector2d(1.8, 0.2).asDiagonal();
  const FittedMode fitted = FitForward(0, shape, 1000);
  const ExplainedMode mode{fitted.mode, Explain(fitted.matches, fitted.mode)};
  const NoiseShape found = FitNoiseShape(fitted.problem, mode).value_or(NoiseShape{});
  EXPECT_NEAR(found.gain_of_all, found.gain * mode.explanation.num_explained / 512.0,
              1e-9 * found.gain_of_all);
  EXPECT_GT(found.gain, 12.0);
}

TEST(FitNoiseShape, OfAFewMatchesIsIsotropic) {
  const NoiseShape found = FitShape(FitForward(0, Eigen::Vector2d(1.8, 0.2).asDiagonal(), 15));
  EXPECT_EQ(found.gain, 0.0);
  EXPECT_EQ(found.Covariance(), Eigen::Matrix2d(Eigen::Matrix2d::Identity()));
}

TEST(IsNoiseAnisotropic, NotIfSomethingElseExplainsTheResiduals) {
  const NoiseShape clear{0.5, 0.0, 40.0, 40.0};
  EXPECT_TRUE(IsNoiseAnisotropic(clear, {}));
  ModelCheck check;
  check.calibration.root_gain = 8.0;  // 32 nats
  EXPECT_TRUE(IsNoiseAnisotropic(clear, check));
  check.calibration.root_gain = 9.0;
  EXPECT_FALSE(IsNoiseAnisotropic(clear, check));
  check = {};
  check.neighbour_z = -7.5;
  EXPECT_FALSE(IsNoiseAnisotropic(clear, check));
  EXPECT_FALSE(IsNoiseAnisotropic({0.5, 0.0, 11.0, 90.0}, {}));
  EXPECT_FALSE(IsNoiseAnisotropic({0.1, 0.2, 40.0, 40.0}, {}));
}

}  // namespace
}  // namespace rcme
