#include "estimator/refinement/m_estimation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "estimator/refinement/sampson_mle.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr MEstimation kHuber{RobustLoss::kHuber, 0.0}, kTukey{RobustLoss::kTukey, 0.0};

TEST(RobustLoss, IsWhatTheFormulasGiveByHand) {
  const auto expect = [](const RobustTerms& terms, double rho, double psi, double weight, double slope) {
    EXPECT_NEAR(terms.rho, rho, 1e-12);
    EXPECT_NEAR(terms.psi, psi, 1e-12);
    EXPECT_NEAR(terms.weight, weight, 1e-12);
    EXPECT_NEAR(terms.slope, slope, 1e-12);
  };
  expect(EvaluateRobustLoss({RobustLoss::kHuber, 2.0}, 1.0), 0.5, 1.0, 1.0, 1.0);
  expect(EvaluateRobustLoss({RobustLoss::kHuber, 2.0}, -5.0), 8.0, -2.0, 0.4, 0.0);
  // u = 1/4: rho = 16/6 (1 - 27/64), psi = 2 9/16, slope = 3/4 (1 - 5/4).
  expect(EvaluateRobustLoss({RobustLoss::kTukey, 4.0}, 2.0), 37.0 / 24.0, 1.125, 0.5625, -0.1875);
  expect(EvaluateRobustLoss({RobustLoss::kTukey, 4.0}, 5.0), 16.0 / 6.0, 0.0, 0.0, 0.0);
}

TEST(RobustLoss, PsiAndItsSlopeAreDerivatives) {
  constexpr double kStep = 1e-5;
  for (const MEstimation& loss : {kHuber, kTukey}) {
    for (const double r : {-6.0, -2.0, -0.5, 0.1, 1.0, 1.3, 4.0, 5.0}) {
      const RobustTerms below = EvaluateRobustLoss(loss, r - kStep), at = EvaluateRobustLoss(loss, r),
                        above = EvaluateRobustLoss(loss, r + kStep);
      EXPECT_NEAR((above.rho - below.rho) / (2.0 * kStep), at.psi, 1e-8) << r;
      EXPECT_NEAR((above.psi - below.psi) / (2.0 * kStep), at.slope, 1e-8) << r;
      EXPECT_NEAR(at.weight * r, at.psi, 1e-12) << r;
    }
  }
}

// (E psi')^2 / E psi^2 of a standard normal is the efficiency.
TEST(RobustLoss, DefaultsAreOf95PercentEfficiency) {
  for (const MEstimation& loss : {kHuber, kTukey}) {
    double slope = 0.0, square = 0.0;
    for (double r = -10.0; r <= 10.0; r += 1e-3) {
      const RobustTerms terms = EvaluateRobustLoss(loss, r);
      const double density = std::exp(-0.5 * r * r) / std::sqrt(2.0 * std::numbers::pi) * 1e-3;
      slope += terms.slope * density;
      square += terms.psi * terms.psi * density;
    }
    EXPECT_NEAR(slope * slope / square, 0.95, 0.0005);
  }
}

RefinedMotion FitTrial(const MEstimation& options, double outlier_ratio, std::uint32_t trial,
                       RelativePose* pose_true) {
  const MotionProblem problem = TwoCameraProblem(200, 0.5, outlier_ratio, trial, pose_true);
  return RefineByMEstimation(problem, *pose_true, options);
}

// The reported covariance against the truth. 300 problems; at the true rate the test fails with probability
// 1e-4, and a variance that is 25 % off gives a rate of 0.905 or 0.975.
TEST(MEstimation, CovarianceCoversWhereNothingIsWrong) {
  for (const MEstimation& options : {kHuber, kTukey}) {
    CoverageCount covered;
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
      RelativePose pose_true;
      const RefinedMotion motion = FitTrial(options, 0.0, trial, &pose_true);
      ASSERT_TRUE(motion.converged);
      const Vector5d error = LocalCoordinates(motion.cam2_from_cam1, pose_true);
      covered.Add(NormalizedErrorSquared(error, motion.pose_cov) <= ChiSquareQuantile(5, 0.95));
    }
    EXPECT_TRUE(covered.Admits(0.94)) << covered;  // 200 matches estimate the spread of psi: a little below
  }
}

// And where each match's own noise is stated: 200 precise matches decide.
TEST(MEstimation, CovarianceCoversWhereMatchesAreNotAlike) {
  for (const MEstimation& options : {kHuber, kTukey}) {
    CoverageCount covered;
    for (std::uint32_t trial = 0; trial < 300; ++trial) {
      RelativePose pose_true;
      MotionProblem problem = TwoCameraProblem(600, 0.0, 0.0, trial, &pose_true);
      problem.sigma_px = 0.3;
      RandomStream rng({.seed = 1, .trial = trial, .purpose = 97});
      for (size_t i = 0; i < problem.matches.size(); ++i) {
        problem.noise_scale.push_back(i % 3 == 0 ? 0.5 : i % 3 == 1 ? 1.0 : 3.0);
        for (double* x_px : {&problem.matches[i].x1_px.x(), &problem.matches[i].x1_px.y(),
                             &problem.matches[i].x2_px.x(), &problem.matches[i].x2_px.y()})
          *x_px += problem.noise_scale[i] * problem.sigma_px * rng.Normal();
      }
      const RefinedMotion motion = RefineByMEstimation(problem, pose_true, options);
      ASSERT_TRUE(motion.converged);
      const Vector5d error = LocalCoordinates(motion.cam2_from_cam1, pose_true);
      covered.Add(NormalizedErrorSquared(error, motion.pose_cov) <= ChiSquareQuantile(5, 0.95));
    }
    EXPECT_TRUE(covered.Admits(0.94)) << covered;
  }
}

// Of wrong matches a redescending loss takes no notice; Huber's is drawn by each with the same force.
TEST(MEstimation, TukeyIgnoresWhatIsWrong) {
  Moments huber, tukey;
  for (std::uint32_t trial = 0; trial < 100; ++trial) {
    RelativePose pose_true;
    for (const bool is_tukey : {false, true}) {
      const RefinedMotion motion = FitTrial(is_tukey ? kTukey : kHuber, 0.3, trial, &pose_true);
      EXPECT_TRUE(motion.converged || !is_tukey);
      if (motion.converged)
        (is_tukey ? tukey : huber).Add(RotationAngleBetween(motion.cam2_from_cam1.R, pose_true.R));
    }
  }
  EXPECT_LT(tukey.mean() + 2.0 * tukey.standard_error(), huber.mean());
}

TEST(MEstimation, OfAWideLossIsLeastSquares) {
  RelativePose pose_true;
  const MotionProblem problem = TwoCameraProblem(200, 0.5, 0.0, 0, &pose_true);
  const RefinedMotion squared = RefineAllBySampson(problem, pose_true);
  for (const RobustLoss loss : {RobustLoss::kHuber, RobustLoss::kTukey}) {
    const RefinedMotion wide = RefineByMEstimation(problem, pose_true, {loss, 1e4});
    ASSERT_TRUE(wide.converged);
    const Vector5d difference = LocalCoordinates(wide.cam2_from_cam1, squared.cam2_from_cam1);
    EXPECT_LT(NormalizedErrorSquared(difference, squared.pose_cov), 1e-4);
  }
}

TEST(MEstimation, OfTooFewMatchesHasNoCovariance) {
  RelativePose pose_true;
  MotionProblem problem = TwoCameraProblem(20, 0.5, 0.0, 0, &pose_true);
  problem.matches.resize(4);
  EXPECT_FALSE(RefineByMEstimation(problem, pose_true, kTukey).converged);
}

}  // namespace
}  // namespace rcme
