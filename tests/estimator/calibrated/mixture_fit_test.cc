// On matches whose motion, noise and share of wrong ones are known.
#include "estimator/calibrated/mixture_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "estimator/kernels/mixture_sums.h"
#include "tests/test_support/calibrated_mode.h"

namespace rcme {
namespace {

constexpr double kMixtureSigmaPx = 0.5;
constexpr double kOutlierRatio = 0.3;
constexpr int kNumMatches = 400;

// Twice the likelihood that a full step would gain.
double Decrement(const FittedMode& f) {
  const Vector5d gradient = SumMixture(f.matches, f.mode.used, f.mode.pose, f.mode.mixture).gradient;
  return gradient.dot(f.mode.inverse_hessian * gradient);
}

TEST(MixtureFit, ReachesTheOptimumFromAnAssumedSigmaWrongByFour) {
  for (const double factor : {0.25, 1.0, 4.0}) {
    for (std::uint32_t trial = 0; trial < 20; ++trial) {
      FittedMode f = FitScene(kNumMatches, kMixtureSigmaPx, kOutlierRatio, trial, factor);
      ASSERT_TRUE(f.has_converged) << factor << " " << trial;
      EXPECT_LT(Decrement(f), 1e-2);
      EXPECT_LT((f.mode.hessian * f.mode.inverse_hessian - Matrix5d::Identity()).norm(), 1e-6);
      // A start beside the optimum, where the decrement is not small, ends there, too.
      Mode other = StartMode(f.matches, f.prior, Retract(f.mode.pose, Vector5d::Constant(2e-3)), 2.0);
      other.hessian = f.mode.hessian;
      ASSERT_TRUE(FitMode(f.matches, f.prior, 50, &other));
      const Vector5d between = LocalCoordinates(f.mode.pose, other.pose);
      EXPECT_LT(between.dot(f.mode.hessian * between), 0.05) << factor << " " << trial;
    }
  }
}

// The prior of two matches of the assumed sigma pulls: sigma^2 = (nu sigma_true^2 + 2 sigma_assumed^2) / (nu
// + 2). Beside it the logarithm of the estimate has a standard deviation of 1 / sqrt(2 nu). The mean over 40
// trials within 4 standard errors and 2 % (wrong matches near their line, and weights that grow with the
// scale, widen it a little): a false alarm in 16,000 runs. A scale of one for scale_of_gaussian, sigma 14 %
// less, is found with certainty.
TEST(MixtureFit, EstimatesTheNoiseLevelFromAnAssumedOneWrongByFour) {
  constexpr int kNumTrials = 40;
  for (const double factor : {0.25, 1.0, 4.0}) {
    const double allowed = 0.02 * std::sqrt(2.0 * (1.0 - kOutlierRatio) * kNumMatches);
    double sum_z = 0.0, sum_squares = 0.0;
    for (std::uint32_t trial = 100; trial < 100 + kNumTrials; ++trial) {
      const FittedMode f = FitScene(kNumMatches, kMixtureSigmaPx, kOutlierRatio, trial, factor);
      const MixtureParameters& m = f.mode.mixture;
      const double nu = (1.0 - kOutlierRatio) * kNumMatches - 5.0;
      const double sigma = f.problem.sigma_px * m.scale / m.noise.scale_of_gaussian;
      const double expected = kMixtureSigmaPx * std::sqrt((nu + 2.0 * factor * factor) / (nu + 2.0));
      const double z = std::log(sigma / expected) * std::sqrt(2.0 * nu);
      sum_z += z;
      sum_squares += z * z;
    }
    EXPECT_LT(std::abs(sum_z / kNumTrials), 4.0 / std::sqrt(kNumTrials) + allowed) << factor;
    EXPECT_LT(sum_squares / kNumTrials, 2.0) << factor;
    EXPECT_GT(sum_squares / kNumTrials, 0.4) << factor;
  }
}

TEST(MixtureFit, EstimatesTheShareOfRightMatches) {
  for (const double outlier_ratio : {0.0, 0.3, 0.6}) {
    const FittedMode f = FitScene(kNumMatches, kMixtureSigmaPx, outlier_ratio, 1);
    // Wrong matches that lie near their epipolar line by chance count as right ones.
    EXPECT_NEAR(f.mode.mixture.inlier_ratio, 1.0 - outlier_ratio, 0.05);
  }
}

TEST(MixtureFit, KeepsTheMixtureWhereItIsToldTo) {
  const FittedMode f = FitScene(100, kMixtureSigmaPx, 0.2, 3);
  Mode fixed = StartMode(f.matches, f.prior, f.pose_true, 1.7);
  ASSERT_TRUE(FitMode(f.matches, f.prior, 50, &fixed, MixtureUpdate::kNone));
  EXPECT_EQ(fixed.mixture.scale, 1.7);
  EXPECT_EQ(fixed.mixture.inlier_ratio, 0.7);
  Mode known = StartMode(f.matches, f.prior, f.pose_true, 1.7);
  ASSERT_TRUE(FitMode(f.matches, {f.prior.uniform_density, false}, 50, &known));
  EXPECT_EQ(known.mixture.scale, 1.7);
  EXPECT_NE(known.mixture.inlier_ratio, 0.7);
}

TEST(MixtureFit, DoesNotConvergeWhereNothingDeterminesTheMotion) {
  const FittedMode f = FitScene(20, kMixtureSigmaPx, 0.0, 2);
  Mode of_four = StartMode(f.matches, f.prior, f.pose_true);
  of_four.used = f.matches.Empty();
  of_four.used[0] = 0b1111;
  of_four.mixture.inlier_ratio = 0.9;
  EXPECT_FALSE(FitMode(f.matches, f.prior, 50, &of_four) && of_four.inverse_hessian.norm() < 1.0);
  Mode of_none = of_four;
  of_none.used = f.matches.Empty();
  EXPECT_FALSE(FitMode(f.matches, f.prior, 50, &of_none));
}

// The mixture that is found reproduces itself: the scale with two matches of the assumed sigma and five
// degrees of freedom less, the share with half a match on either side, the density of wrong ones with five of
// the prior. Few matches, so that each of these is seen.
TEST(MixtureFit, IsWhereExpectationMaximisationStaysPut) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    FittedMode f = FitScene(40, kMixtureSigmaPx, kOutlierRatio, trial);
    ASSERT_TRUE(f.has_converged);
    for (int step = 0; step < 40; ++step)
      FitMode(f.matches, f.prior, 1, &f.mode);  // beyond a negligible step
    const MixtureParameters& m = f.mode.mixture;
    const MixtureSums sums = SumMixture(f.matches, f.mode.used, f.mode.pose, m);
    const double of_gaussian = m.noise.scale_of_gaussian;
    const double variance =
        (sums.sum_squares + 2.0 * of_gaussian * of_gaussian) / (sums.num_right - 5.0 + 2.0);
    EXPECT_NEAR(m.scale, std::sqrt(variance), 2e-3 * m.scale);
    EXPECT_NEAR(m.inlier_ratio, (sums.num_right + 0.5) / 41.0, 1e-3);
    const double wrong = 40.0 - sums.num_right;
    const double density = (sums.num_wrong_near + 5.0) / (60.0 * wrong + 5.0 / f.prior.uniform_density);
    EXPECT_NEAR(m.outlier_density, density, 1e-2 * density);
  }
}

// Five steps of the share and the density from one half, over all matches whichever are used.
TEST(FitShares, IsFiveStepsByHand) {
  FittedMode f = FitScene(60, kMixtureSigmaPx, kOutlierRatio, 1);
  double share = 0.5, density = f.mode.mixture.outlier_density;
  for (int step = 0; step < 5; ++step) {
    MixtureParameters m = f.mode.mixture;
    m.inlier_ratio = share;
    m.outlier_density = density;
    const MixtureSums sums = SumMixture(f.matches, f.matches.All(), f.mode.pose, m);
    share = (sums.num_right + 0.5) / 61.0;
    density = (sums.num_wrong_near + 5.0) / (60.0 * (60.0 - sums.num_right) + 5.0 / f.prior.uniform_density);
  }
  const double scale = f.mode.mixture.scale;
  f.mode.used = f.matches.Empty();
  FitShares(f.matches, f.prior, &f.mode);
  EXPECT_NEAR(f.mode.mixture.inlier_ratio, share, 1e-12);
  EXPECT_NEAR(f.mode.mixture.outlier_density, density, 1e-12);
  EXPECT_EQ(f.mode.mixture.scale, scale);
}

// One step from ten standard deviations away is a long one: not yet an optimum.
TEST(MixtureFit, IsNoOptimumAfterALongStep) {
  const FittedMode f = FitScene(kNumMatches, kMixtureSigmaPx, 0.0, 1);
  const Matrix5d root = f.mode.inverse_hessian.llt().matrixL();
  for (const double away : {10.0, 1e-3}) {
    Mode mode = f.mode;
    mode.pose = Retract(f.mode.pose, away * root.col(0));
    EXPECT_EQ(FitMode(f.matches, f.prior, 1, &mode), away < 1.0);
  }
}

}  // namespace
}  // namespace rcme
