#include "estimator/geometry/sampson.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kStepPx = 0.5;  // third derivatives in px are ~ 1e-6 of the first ones

Correspondence MakeMatch(const Eigen::VectorXd& X) { return {X.head<2>(), X.tail<2>()}; }
Eigen::Vector4d StackCoordinates(const Correspondence& match) {
  Eigen::Vector4d X;
  X << match.x1_px, match.x2_px;
  return X;
}

// A motion, its F and dF/dp, and a match that is off by a few px: g is far from zero.
struct Case {
  RandomProblem random;
  Eigen::Matrix3d F;
  std::array<Eigen::Matrix3d, 5> dF_dp;
  Correspondence match;
};

Eigen::Matrix3d ComputeFundamental(const RandomProblem& random, const RelativePose& pose) {
  return FundamentalFromEssential(EssentialFromPose(pose), random.problem.camera1, random.problem.camera2);
}

Case MakeCase(RandomStream& rng, double sigma_px) {
  Case made;
  made.random = MakeRandomProblem(rng, {.num_matches = 1, .max_rotation_deg = 30.0});
  AddNoise(sigma_px, rng, &made.random.problem);
  made.match = made.random.problem.matches[0];
  made.F = ComputeFundamental(made.random, made.random.pose_true);
  const std::array<Eigen::Matrix3d, 5> dE_dp = EssentialTangent(made.random.pose_true);
  for (size_t k = 0; k < 5; ++k) {
    made.dF_dp[k] =
        FundamentalFromEssential(dE_dp[k], made.random.problem.camera1, made.random.problem.camera2);
  }
  return made;
}

TEST(EpipolarConstraint, GradientHasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 80});
  for (int i = 0; i < 50; ++i) {
    const Case c = MakeCase(rng, 5.0);
    const auto g = [&](const Eigen::VectorXd& X) {
      const Correspondence match = MakeMatch(X);
      return Eigen::VectorXd::Constant(1, match.x2_px.homogeneous().dot(c.F * match.x1_px.homogeneous()));
    };
    const EpipolarConstraint constraint = EvaluateConstraint(c.F, c.match);
    EXPECT_NEAR(constraint.g, g(StackCoordinates(c.match))(0), 1e-15);
    EXPECT_DOUBLE_EQ(constraint.squared_gradient(), constraint.gradient.dot(constraint.gradient));
    EXPECT_JACOBIAN_NEAR(constraint.gradient.transpose(),
                         NumericJacobian(g, StackCoordinates(c.match), kStepPx), 1e-9);
  }
}

TEST(ConstraintHessian, HasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 81});
  for (int i = 0; i < 50; ++i) {
    const Case c = MakeCase(rng, 5.0);
    const auto gradient = [&](const Eigen::VectorXd& X) -> Eigen::VectorXd {
      return EvaluateConstraint(c.F, MakeMatch(X)).gradient;
    };
    EXPECT_JACOBIAN_NEAR(ConstraintHessian(c.F), NumericJacobian(gradient, StackCoordinates(c.match), 10.0),
                         1e-9);
  }
}

TEST(SampsonVector, IsTheFirstNewtonStepToTheEpipolarVariety) {
  // delta is the shortest solution of J delta = -g, and moving by it takes |g| from first to second order.
  RandomStream rng({.seed = 1, .purpose = 82});
  for (int i = 0; i < 50; ++i) {
    const Case c = MakeCase(rng, 1.0);
    const EpipolarConstraint before = EvaluateConstraint(c.F, c.match);
    const Eigen::Vector4d delta = SampsonVector(c.F, c.match);
    EXPECT_NEAR(before.gradient.dot(delta), -before.g, 1e-12 * std::abs(before.g));
    EXPECT_NEAR(std::abs(before.gradient.dot(delta)), before.gradient.norm() * delta.norm(),
                1e-12 * std::abs(before.g));
    EXPECT_NEAR(delta.squaredNorm(), SquaredSampsonDistance(c.F, c.match), 1e-12 * delta.squaredNorm());
    const EpipolarConstraint after = EvaluateConstraint(c.F, MakeMatch(StackCoordinates(c.match) + delta));
    EXPECT_LT(std::abs(after.g), 0.5 * ConstraintHessian(c.F).norm() * delta.squaredNorm() + 1e-15);
  }
}

TEST(SampsonVector, DoesNotDependOnTheScaleOrSignOfF) {
  RandomStream rng({.seed = 1, .purpose = 83});
  const Case c = MakeCase(rng, 2.0);
  const Eigen::Vector4d delta = SampsonVector(c.F, c.match);
  EXPECT_GT(delta.norm(), 0.01);
  for (const double scale : {-1.0, 1e3, -1e-3}) {
    EXPECT_LT((SampsonVector(scale * c.F, c.match) - delta).norm(), 1e-12 * delta.norm());
  }
}

TEST(SampsonVector, VanishesForAnExactMatch) {
  RandomStream rng({.seed = 1, .purpose = 84});
  for (int i = 0; i < 50; ++i) {
    const Case c = MakeCase(rng, 0.0);
    EXPECT_LT(SampsonVector(c.F, c.match).norm(), 1e-9);
  }
}

TEST(SampsonVector, PointJacobianHasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 85});
  for (const double sigma_px : {0.0, 0.5, 20.0}) {
    for (int i = 0; i < 50; ++i) {
      const Case c = MakeCase(rng, sigma_px);
      const auto delta = [&](const Eigen::VectorXd& X) -> Eigen::VectorXd {
        return SampsonVector(c.F, MakeMatch(X));
      };
      EXPECT_JACOBIAN_NEAR(SampsonVectorPointJacobian(c.F, c.match),
                           NumericJacobian(delta, StackCoordinates(c.match), kStepPx), 1e-7);
    }
  }
}

TEST(SampsonVector, PoseJacobianHasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 86});
  for (const double sigma_px : {0.0, 0.5, 20.0}) {
    for (int i = 0; i < 50; ++i) {
      const Case c = MakeCase(rng, sigma_px);
      const auto delta = [&](const Eigen::VectorXd& tangent) -> Eigen::VectorXd {
        return SampsonVector(ComputeFundamental(c.random, Retract(c.random.pose_true, tangent)), c.match);
      };
      EXPECT_JACOBIAN_NEAR(SampsonVectorPoseJacobian(c.F, c.dF_dp, c.match),
                           NumericJacobian(delta, Vector5d::Zero(), 1e-4), 1e-7);
    }
  }
}

TEST(SampsonVector, BothJacobiansHaveRankOneOnTheVariety) {
  // At g = 0 both are multiples of J', so Sigma_delta has rank one to first order.
  RandomStream rng({.seed = 1, .purpose = 87});
  for (int i = 0; i < 20; ++i) {
    const Case c = MakeCase(rng, 0.0);
    const Eigen::Vector4d unit = EvaluateConstraint(c.F, c.match).gradient.normalized();
    const Eigen::Matrix4d off = Eigen::Matrix4d::Identity() - unit * unit.transpose();
    const Eigen::Matrix4d by_point = SampsonVectorPointJacobian(c.F, c.match);
    const Eigen::Matrix<double, 4, 5> by_pose = SampsonVectorPoseJacobian(c.F, c.dF_dp, c.match);
    EXPECT_NEAR(by_point.norm(), 1.0, 1e-9);  // -J'J / n2 is a projection
    EXPECT_LT((off * by_point).norm(), 1e-9);
    EXPECT_GT(by_pose.norm(), 1.0);  // px per rad
    EXPECT_LT((off * by_pose).norm(), 1e-9 * by_pose.norm());
  }
}

}  // namespace
}  // namespace rcme
