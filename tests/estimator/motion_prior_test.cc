// The prior of a motion: residuals against numeric derivatives and closed forms, and their law.
#include "estimator/motion_prior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

Eigen::Vector3d Normals(RandomStream& rng) {
  const double x = rng.Normal(), y = rng.Normal(), z = rng.Normal();
  return {x, y, z};
}

// A vector turned by isotropic noise.
Eigen::Vector3d TurnedBy(const Eigen::Vector3d& v, double sd_rad, RandomStream& rng) {
  const Eigen::Vector3d w = sd_rad * Normals(rng);
  return RotationFromVector(w - w.dot(v) * v) * v;
}

// Correlated noise of the rotation, unequal noise of gravity.
MotionPrior MeasureMotion(const RelativePose& pose, double sd_rad, RandomStream& rng) {
  Eigen::Matrix3d root;
  root << 1.0, 0.0, 0.0, 0.4, 0.7, 0.0, -0.3, 0.5, 1.2;
  const Eigen::Vector3d down = RandomDirection(rng);
  return {RotationPrior{RotationFromVector(-sd_rad * root * Normals(rng)) * pose.R,
                        sd_rad * sd_rad * root * root.transpose()},
          GravityPrior{TurnedBy(down, 0.5 * sd_rad, rng), TurnedBy(pose.R * down, 2.0 * sd_rad, rng),
                       0.5 * sd_rad, 2.0 * sd_rad},
          DirectionPrior{TurnedBy(pose.t, 3.0 * sd_rad, rng), 3.0 * sd_rad}};
}

// Near the measurements, where the series are used, and far from them.
TEST(MotionPrior, JacobiansAreThoseOfTheResiduals) {
  RandomStream rng({.seed = 1, .purpose = 4101});
  for (const double away_rad : {1e-6, 2e-4, 0.02, 0.5, 1.5}) {
    for (int trial = 0; trial < 20; ++trial) {
      const RelativePose measured = RandomPose(rng, 60.0);
      const MotionPrior prior = MeasureMotion(measured, 1e-7, rng);
      Vector5d away = Vector5d::NullaryExpr([&] { return rng.Normal(); });
      const RelativePose pose = Retract(measured, away_rad * away.normalized());
      const PriorResiduals at = ComputePriorResiduals(prior, pose);
      const auto residual = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
        return ComputePriorResiduals(prior, Retract(pose, step)).residual;
      };
      EXPECT_JACOBIAN_NEAR(at.jacobian, NumericJacobian(residual, Eigen::VectorXd::Zero(5), 1e-3), 1e-6);
    }
  }
}

TEST(MotionPrior, CostGradientAndHessianAreThoseOfTheDensity) {
  RandomStream rng({.seed = 1, .purpose = 4102});
  for (int trial = 0; trial < 20; ++trial) {
    const RelativePose measured = RandomPose(rng, 60.0);
    const MotionPrior prior = MeasureMotion(measured, 0.05, rng);
    Vector5d away = Vector5d::NullaryExpr([&] { return rng.Normal(); });
    const RelativePose pose = Retract(measured, 0.1 * away);
    const auto cost = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
      return Eigen::VectorXd::Constant(1, EvaluatePrior(prior, Retract(pose, step)).cost);
    };
    const PriorTerms terms = EvaluatePrior(prior, pose);
    EXPECT_JACOBIAN_NEAR(terms.gradient.transpose(), NumericJacobian(cost, Eigen::VectorXd::Zero(5), 1e-3),
                         1e-6);
    // Gauss-Newton: exact where the measurements are met.
    const MotionPrior met = {
        RotationPrior{pose.R, prior.rotation->cov},
        GravityPrior{prior.gravity->in_cam1, pose.R * prior.gravity->in_cam1, 0.03, 0.04},
        DirectionPrior{pose.t, 0.1}};
    const auto gradient = [&](const Eigen::VectorXd& step) -> Eigen::VectorXd {
      return EvaluatePrior(met, Retract(pose, step)).gradient;
    };
    EXPECT_JACOBIAN_NEAR(EvaluatePrior(met, pose).hessian,
                         NumericJacobian(gradient, Eigen::VectorXd::Zero(5), 1e-3), 1e-4);
  }
}

// By hand: a turn about each axis, gravity that does not see a turn about itself, an angle of the direction.
TEST(MotionPrior, CostsOfMotionsByHand) {
  const RelativePose pose{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ()};
  const auto turned = [&](const Eigen::Vector3d& w) { return RelativePose{RotationFromVector(w), pose.t}; };
  MotionPrior rotation{RotationPrior{pose.R, Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal()}};
  EXPECT_NEAR(EvaluatePrior(rotation, turned({0.2, 0.0, 0.0})).cost, 2.0, 1e-12);
  EXPECT_NEAR(EvaluatePrior(rotation, turned({0.0, 0.2, 0.0})).cost, 0.5, 1e-12);
  EXPECT_NEAR(EvaluatePrior(rotation, turned({0.0, 0.0, -0.6})).cost, 2.0, 1e-12);
  MotionPrior gravity{{}, GravityPrior{Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY(), 0.06, 0.08}};
  EXPECT_NEAR(EvaluatePrior(gravity, turned({0.2, 0.0, 0.0})).cost, 2.0, 1e-12);
  EXPECT_NEAR(EvaluatePrior(gravity, turned({0.0, 1.0, 0.0})).cost, 0.0, 1e-12);
  EXPECT_NEAR(EvaluatePrior(gravity, turned({std::numbers::pi, 0.0, 0.0})).cost,
              0.5 * std::pow(std::numbers::pi / 0.1, 2), 1e-6);
  MotionPrior direction{{}, {}, DirectionPrior{Eigen::Vector3d::UnitX(), 0.5}};
  EXPECT_NEAR(EvaluatePrior(direction, pose).cost, 0.5 * std::numbers::pi * std::numbers::pi, 1e-12);
  EXPECT_EQ(CountPriorFreedom(rotation) + CountPriorFreedom(gravity) + CountPriorFreedom(direction), 7);
}

// The squared angle to a measurement has no curvature across the way to it that is greater than 1 (by hand,
// angle / tan(angle)). Where the measurement is nearly opposite, the information of the residuals may not be
// far more; the gradient is still that of the cost.
TEST(MotionPrior, NearlyOppositeMeasurementsHaveNoMoreInformation) {
  RandomStream rng({.seed = 1, .purpose = 2851});
  const double sd = 0.5, right_angle = 0.5 * std::numbers::pi;
  for (const double from_opposite_rad : {1e-7, 1e-4, 0.01, 0.3, 1.4}) {
    const RelativePose pose = RandomPose(rng, 60.0);
    const double angle = std::numbers::pi - from_opposite_rad;
    const Eigen::Vector3d opposite = RotationFromVector(angle * DirectionBasis(pose.t).col(0)) * pose.t;
    const MotionPrior prior{{}, {}, DirectionPrior{opposite, sd}};
    const PriorTerms terms = EvaluatePrior(prior, pose);
    const Eigen::Matrix2d information = terms.hessian.bottomRightCorner<2, 2>() * sd * sd;
    EXPECT_NEAR(information.determinant(), right_angle * right_angle, 1e-3) << from_opposite_rad;
    EXPECT_NEAR(information.trace(), 1.0 + right_angle * right_angle, 1e-3) << from_opposite_rad;
    EXPECT_NEAR(terms.gradient.tail<2>().norm() * sd * sd, angle, 1e-5) << from_opposite_rad;
    const Eigen::Vector3d below = pose.R.transpose() * opposite;  // seen by camera 1, and its opposite by 2
    const MotionPrior gravity{{}, GravityPrior{below, pose.t, 0.6 * sd, 0.8 * sd}};
    EXPECT_LE(EvaluatePrior(gravity, pose).hessian.trace() * sd * sd, 1.001 + right_angle * right_angle);
  }
}

// The rotation that the documentation states: true R = Exp(w) R_measured.
TEST(MotionPrior, CovarianceIsOnTheSideOfPoseCov) {
  const Eigen::Matrix3d R = RotationFromVector({0.3, -1.1, 0.4});
  const MotionPrior prior{RotationPrior{R, Eigen::Vector3d(1e-2, 1e2, 1e2).asDiagonal()}};
  const RelativePose left{RotationFromVector({0.3, 0.0, 0.0}) * R, Eigen::Vector3d::UnitX()};
  EXPECT_NEAR(EvaluatePrior(prior, left).cost, 4.5, 1e-12);
}

// Measurements and motion both with noise: the tail is uniform. At 0.05 a false alarm of this test has
// probability 1e-4. Without the covariance of the motion, or without that of the measurements, it is off by
// more than a tenth.
TEST(MotionPrior, TailIsUniformForRightMeasurements) {
  RandomStream rng({.seed = 1, .purpose = 4103});
  CoverageCount below, disagreeing;
  for (int trial = 0; trial < 4000; ++trial) {
    const RelativePose truth = RandomPose(rng, 60.0);
    const MotionPrior prior = MeasureMotion(truth, 0.01, rng);
    Matrix5d root = Matrix5d::NullaryExpr([&] { return 0.01 * rng.Normal(); });
    const Vector5d error = root * Vector5d::NullaryExpr([&] { return rng.Normal(); });
    const RelativePose pose = Retract(truth, error);
    below.Add(ComputePriorTail(prior, pose, root * root.transpose()) < 0.05);
    disagreeing.Add(ComputePriorAgreement(prior) < 0.05);
  }
  EXPECT_TRUE(below.Admits(0.05)) << below;
  EXPECT_TRUE(disagreeing.Admits(0.05)) << disagreeing;
  EXPECT_EQ(ComputePriorAgreement({{}, GravityPrior{}, DirectionPrior{}}), 1.0);
}

// By integration of the density over random rotations and directions.
TEST(MotionPrior, PeakOverUniformIsThatOfAUnitMass) {
  RandomStream rng({.seed = 1, .purpose = 4104});
  const double sd = 0.3;
  const MotionPrior rotation{
      RotationPrior{Eigen::Matrix3d::Identity(), sd * sd * Eigen::Matrix3d::Identity()}},
      direction{{}, {}, DirectionPrior{Eigen::Vector3d::UnitX(), sd}},
      gravity{{}, GravityPrior{Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitY(), 0.6 * sd, 0.8 * sd}};
  double sum_rotation = 0.0, sum_direction = 0.0, sum_gravity = 0.0;
  constexpr int kNumDraws = 400000;
  for (int draw = 0; draw < kNumDraws; ++draw) {
    Eigen::Quaterniond q(rng.Normal(), rng.Normal(), rng.Normal(), rng.Normal());
    const RelativePose pose{q.normalized().toRotationMatrix(), RandomDirection(rng)};
    sum_rotation += std::exp(-EvaluatePrior(rotation, pose).cost);
    sum_direction += std::exp(-EvaluatePrior(direction, pose).cost);
    sum_gravity += std::exp(-EvaluatePrior(gravity, pose).cost);
  }
  // The tangent of a sphere is flat to some per cent at this width.
  EXPECT_NEAR(std::exp(LogPeakOverUniform(rotation)) * sum_rotation / kNumDraws, 1.0, 0.08);
  EXPECT_NEAR(std::exp(LogPeakOverUniform(direction)) * sum_direction / kNumDraws, 1.0, 0.08);
  EXPECT_NEAR(std::exp(LogPeakOverUniform(gravity)) * sum_gravity / kNumDraws, 1.0, 0.08);
  EXPECT_EQ(LogPeakOverUniform({{}, {}, DirectionPrior{Eigen::Vector3d::UnitX(), 1e3}}), 0.0);
}

TEST(MotionPrior, WhatCannotBeUsedIsNamed) {
  RandomStream rng({.seed = 1, .purpose = 4105});
  const MotionPrior good = MeasureMotion(RandomPose(rng, 30.0), 0.01, rng);
  EXPECT_EQ(FindPriorFault(good), "");
  EXPECT_NE(FindPriorFault({}), "");
  MotionPrior bad = good;
  bad.rotation->R(0, 0) += 0.01;
  EXPECT_NE(FindPriorFault(bad).find("rotation"), std::string::npos);
  bad = good;
  bad.rotation->R *= -1.0;
  EXPECT_NE(FindPriorFault(bad).find("rotation"), std::string::npos);
  bad = good;
  bad.rotation->cov(0, 1) += 1e-5;
  EXPECT_NE(FindPriorFault(bad).find("symmetric"), std::string::npos);
  bad = good;
  bad.rotation->cov = Eigen::Vector3d(1e-4, 1e-4, 0.0).asDiagonal();
  EXPECT_NE(FindPriorFault(bad).find("standard deviation"), std::string::npos);
  bad = good;
  bad.gravity->in_cam2 *= 1.1;
  EXPECT_NE(FindPriorFault(bad).find("gravity in camera 2"), std::string::npos);
  bad = good;
  bad.gravity->sd1_rad = std::nan("");
  EXPECT_NE(FindPriorFault(bad).find("gravity in camera 1"), std::string::npos);
  bad = good;
  bad.direction->t = Eigen::Vector3d::Constant(std::nan(""));
  EXPECT_NE(FindPriorFault(bad).find("direction"), std::string::npos);
  bad = good;
  bad.direction->sd_rad = 0.0;
  EXPECT_NE(FindPriorFault(bad).find("direction"), std::string::npos);
}

}  // namespace
}  // namespace rcme
