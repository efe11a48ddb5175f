#include "estimator/calibrated/prior_check.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "estimator/calibrated/mode_covariance.h"
#include "estimator/calibrated/mode_weights.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/calibrated_mode.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"

namespace rcme {
namespace {

RelativePose TurnedBy(double angle_rad) {
  return {RotationFromVector({0.0, angle_rad, 0.0}), Eigen::Vector3d::UnitZ()};
}
MotionBelief Believe(double angle_rad, double sd_rad, double weight) {
  return {TurnedBy(angle_rad), sd_rad * sd_rad * Matrix5d::Identity(), weight};
}
const MotionPrior kMeasuredPrior{
    RotationPrior{Eigen::Matrix3d::Identity(), 9e-4 * Eigen::Matrix3d::Identity()}};

// 0.2 rad by standard deviations of 0.03 and 0.04: 4 standard deviations of both.
TEST(PriorPValue, IsTheTailByBothCovariances) {
  const std::vector<MotionBelief> one = {Believe(0.2, 0.04, 1.0)};
  EXPECT_NEAR(ComputePriorPValue(kMeasuredPrior, one), 1.0 - ChiSquareCdf(3, 16.0), 1e-9);
}

// The prior's part is to choose among the motions that the matches leave.
TEST(PriorPValue, IsOfTheMotionNearestToIt) {
  const std::vector<MotionBelief> both = {Believe(0.5, 0.01, 0.99), Believe(0.0, 0.01, 0.01)};
  EXPECT_NEAR(ComputePriorPValue(kMeasuredPrior, both), 1.0, 1e-12);
  const std::vector<MotionBelief> negligible = {Believe(0.5, 0.01, 1.0), Believe(0.0, 0.01, 1e-6)};
  EXPECT_LT(ComputePriorPValue(kMeasuredPrior, negligible), kPriorLevel);
  EXPECT_EQ(ComputePriorPValue(kMeasuredPrior, {}), 1.0);
}

MotionPrior MeasureRotation(const RelativePose& truth, double sd_rad, RandomStream& rng) {
  Eigen::Vector3d noise;
  for (double& x : noise) x = sd_rad * rng.Normal();
  return {RotationPrior{RotationFromVector(noise) * truth.R, sd_rad * sd_rad * Eigen::Matrix3d::Identity()}};
}

TEST(SumPosterior, HasTheDerivativesOfLikelihoodAndPrior) {
  FittedMode f = FitScene(100, 0.5, 0.2, 3);
  RandomStream rng({.seed = 1, .purpose = 4121});
  const MotionPrior motion = MeasureRotation(f.pose_true, 0.01, rng);
  f.prior.motion = &motion;
  const auto sums = [&](const MixturePrior& prior, const RelativePose& pose) {
    return SumPosterior(f.matches, f.mode.used, prior, pose, f.mode.mixture);
  };
  MixturePrior without = f.prior;
  without.motion = nullptr;
  const MixtureSums both = sums(f.prior, f.mode.pose), alone = sums(without, f.mode.pose);
  const PriorTerms terms = EvaluatePrior(motion, f.mode.pose);
  EXPECT_EQ(both.log_likelihood, alone.log_likelihood - terms.cost);
  EXPECT_EQ(both.hessian, alone.hessian + terms.hessian);
  const auto cost = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
    return Eigen::VectorXd::Constant(1, -sums(f.prior, Retract(f.mode.pose, step)).log_likelihood);
  };
  EXPECT_JACOBIAN_NEAR(both.gradient.transpose(), NumericJacobian(cost, Eigen::VectorXd::Zero(5), 1e-5),
                       1e-3);
}

// At the optimum of both the gradients of likelihood and prior cancel.
TEST(FitMode, EndsAtTheOptimumOfLikelihoodAndPrior) {
  FittedMode f = FitScene(100, 0.5, 0.2, 4);
  RandomStream rng({.seed = 1, .purpose = 4122});
  const MotionPrior motion = MeasureRotation(f.pose_true, 1e-3, rng);
  f.prior.motion = &motion;
  Mode mode = f.mode;
  ASSERT_TRUE(FitMode(f.matches, f.prior, 30, &mode));
  const MixtureSums at = SumPosterior(f.matches, mode.used, f.prior, mode.pose, mode.mixture);
  EXPECT_LT(at.gradient.dot(mode.inverse_hessian * at.gradient), 1e-3);
  EXPECT_GT(EvaluatePrior(motion, f.mode.pose).cost, EvaluatePrior(motion, mode.pose).cost);
  EXPECT_GT(RotationAngleBetween(f.mode.pose.R, mode.pose.R), 1e-4);
}

// The log density of three measured numbers over its greatest: one in twenty has five times the stated sd.
double LogMixture(double cost) {
  return std::log(0.95 * std::exp(-cost) + 0.05 / 125.0 * std::exp(-cost / 25.0));
}

// Of a normal likelihood: the evidence is log N(r; 0, I + J C J') over that at r = 0 without C, which the
// lemma of determinants turns into Laplace's form at the optimum of both. The normal law is 19 in 20 of it.
TEST(PriorEvidence, IsThatOfAConvolution) {
  RandomStream rng({.seed = 1, .purpose = 4123});
  const RelativePose truth = RandomPose(rng, 30.0);
  const MotionPrior motion = MeasureRotation(truth, 1e-3, rng);
  Matrix5d root = Matrix5d::NullaryExpr([&] { return 3e2 * rng.Normal(); });
  const Matrix5d H = root * root.transpose() + 1e4 * Matrix5d::Identity();
  const PriorResiduals r = ComputePriorResiduals(motion, truth);
  const PriorTerms terms = EvaluatePrior(motion, truth);
  Mode both;
  both.hessian = H + terms.hessian;
  const Vector5d move = -both.hessian.llt().solve(terms.gradient);
  both.pose = Retract(truth, move);
  const double loss = 0.5 * move.dot(H * move);  // of the likelihood, which the contrast of two modes has
  const Eigen::MatrixXd spread = Eigen::MatrixXd::Identity(9, 9) + Propagate(r.jacobian, H.inverse());
  const double expected = LogPeakOverUniform(motion) - 0.5 * SquaredMahalanobis(r.residual, spread) -
                          CholeskyFactor(spread).diagonal().array().log().sum();
  EXPECT_NEAR(ComputePriorEvidence(motion, both) - loss, expected + std::log(0.95), 0.01);
}

// A motion five standard deviations from the measurement against one at three: 2981 to 1 by the normal law.
TEST(PriorEvidence, LeavesRoomForABadMeasurement) {
  const double sd = 0.02;
  MotionPrior motion;
  motion.rotation = {Eigen::Matrix3d::Identity(), sd * sd * Eigen::Matrix3d::Identity()};
  const auto evidence_at = [&](double sds) {
    Mode mode;
    mode.pose = {RotationFromVector({sds * sd, 0.0, 0.0}), Eigen::Vector3d::UnitZ()};
    mode.hessian = 1e12 * Matrix5d::Identity();
    return ComputePriorEvidence(motion, mode);
  };
  EXPECT_NEAR(evidence_at(3.0) - evidence_at(5.0), LogMixture(4.5) - LogMixture(12.5), 1e-3);
  EXPECT_LT(evidence_at(3.0) - evidence_at(5.0), 4.5);
  EXPECT_GT(evidence_at(0.0) - evidence_at(3.0), 4.0);
  EXPECT_TRUE(std::isfinite(evidence_at(1000.0)));
}

// 400 scenes: the fit by matches and prior covers as it says, and its error is what both give. At .95 a false
// alarm has probability 1e-4 (to .94: the covariance of the matches is estimated).
TEST(PriorCovariance, CoversTheTruthAsOftenAsItSays) {
  const double bound = ChiSquareQuantile(5, 0.95);
  CoverageCount covered;
  constexpr std::uint32_t kTrials = 400;
  double with_prior = 0.0, without = 0.0;
  for (std::uint32_t trial = 0; trial < kTrials; ++trial) {
    FittedMode f = FitScene(100, 0.5, 0.0, trial);
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 4124});
    const MotionPrior motion = MeasureRotation(f.pose_true, 1e-3, rng);
    without += std::pow(RotationAngleBetween(f.mode.pose.R, f.pose_true.R), 2);
    f.prior.motion = &motion;
    ASSERT_TRUE(FitMode(f.matches, f.prior, 30, &f.mode)) << trial;
    with_prior += std::pow(RotationAngleBetween(f.mode.pose.R, f.pose_true.R), 2);
    const Matrix5d inverse = InverseOfObserved(f.matches, f.mode, f.prior);
    const Matrix5d covariance = SandwichCovariance(f.mode, Explain(f.matches, f.mode), inverse) +
                                PriorCovariance(f.mode, f.prior, inverse);
    const Vector5d error = LocalCoordinates(f.mode.pose, f.pose_true);
    covered.Add(error.dot(covariance.llt().solve(error)) <= bound);
  }
  EXPECT_LT(covered.interval().lower, 0.99) << covered;
  EXPECT_GT(covered.interval().upper, 0.94) << covered;
  EXPECT_LT(with_prior, 0.9 * without);
}

}  // namespace
}  // namespace rcme
