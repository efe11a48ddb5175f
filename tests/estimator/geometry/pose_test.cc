#include "estimator/geometry/pose.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

constexpr double kPi = std::numbers::pi;

void ExpectSamePose(const RelativePose& a, const RelativePose& b, double tolerance) {
  EXPECT_LT((a.R - b.R).norm(), tolerance);
  EXPECT_LT((a.t - b.t).norm(), tolerance);
}

TEST(CrossMatrix, IsTheCrossProduct) {
  RandomStream rng({.seed = 1, .purpose = 50});
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d v = RandomDirection(rng), u = 3.0 * RandomDirection(rng);
    EXPECT_LT((CrossMatrix(v) * u - v.cross(u)).norm(), 1e-15);
  }
}

TEST(Rotation, QuarterTurnByHand) {
  Eigen::Matrix3d about_z;
  about_z << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  EXPECT_LT((RotationFromVector({0.0, 0.0, kPi / 2}) - about_z).norm(), 1e-15);
  EXPECT_EQ(RotationFromVector(Eigen::Vector3d::Zero()), Eigen::Matrix3d::Identity());
}

TEST(Rotation, VectorRoundTrip) {
  RandomStream rng({.seed = 1, .purpose = 51});
  for (const double angle : {1e-12, 1e-8, 1e-3, 1.0, 2.0, 3.0, kPi - 1e-3, kPi - 1e-6}) {
    for (int i = 0; i < 20; ++i) {
      const Eigen::Vector3d w = angle * RandomDirection(rng);
      const Eigen::Matrix3d R = RotationFromVector(w);
      EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
      EXPECT_NEAR(R.determinant(), 1.0, 1e-14);
      EXPECT_LT((VectorFromRotation(R) - w).norm(), 1e-14 + 1e-13 * angle) << "angle " << angle;
    }
  }
  EXPECT_EQ(VectorFromRotation(Eigen::Matrix3d::Identity()), Eigen::Vector3d::Zero());
}

TEST(Rotation, HalfTurnComesBackAsTheSameRotation) {
  RandomStream rng({.seed = 1, .purpose = 52});
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d R = RotationFromVector(kPi * RandomDirection(rng));
    EXPECT_NEAR(VectorFromRotation(R).norm(), kPi, 1e-12);
    EXPECT_LT((RotationFromVector(VectorFromRotation(R)) - R).norm(), 1e-12);
  }
}

TEST(DirectionBasis, IsOrthonormalAndNormalToT) {
  RandomStream rng({.seed = 1, .purpose = 53});
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d t = i < 6
                                  ? Eigen::Vector3d((i % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(i / 2))
                                  : RandomDirection(rng);
    const Eigen::Matrix<double, 3, 2> basis = DirectionBasis(t);
    EXPECT_LT((basis.transpose() * basis - Eigen::Matrix2d::Identity()).norm(), 1e-14);
    EXPECT_LT((basis.transpose() * t).norm(), 1e-14);
  }
}

TEST(Retract, ZeroIsThePoseItself) {
  RandomStream rng({.seed = 1, .purpose = 54});
  const RelativePose pose = RandomPose(rng, 180.0);
  ExpectSamePose(Retract(pose, Vector5d::Zero()), pose, 1e-16);
}

TEST(Retract, FirstOrderIsTheStatedTangent) {
  // R <- Exp(w) R, t <- normalise(t + B b).
  RandomStream rng({.seed = 1, .purpose = 55});
  for (int i = 0; i < 10; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const auto block = [&](const Eigen::VectorXd& tangent) {
      const RelativePose moved = Retract(pose, tangent);
      Eigen::VectorXd entries(12);
      entries << Eigen::Map<const Eigen::VectorXd>(moved.R.data(), 9), moved.t;
      return entries;
    };
    Eigen::MatrixXd stated = Eigen::MatrixXd::Zero(12, 5);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Matrix3d dR = CrossMatrix(Eigen::Vector3d::Unit(k)) * pose.R;
      stated.block<9, 1>(0, k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(dR.data());
    }
    stated.block<3, 2>(9, 3) = DirectionBasis(pose.t);
    EXPECT_JACOBIAN_NEAR(stated, NumericJacobian(block, Vector5d::Zero(), 1e-3), 1e-10);
  }
}

TEST(Retract, StaysOnTheManifold) {
  RandomStream rng({.seed = 1, .purpose = 56});
  for (int i = 0; i < 100; ++i) {
    Vector5d tangent;
    for (double& x : tangent) x = 2.0 * rng.Normal();
    const RelativePose moved = Retract(RandomPose(rng, 180.0), tangent);
    EXPECT_LT((moved.R.transpose() * moved.R - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_NEAR(moved.t.norm(), 1.0, 1e-14);
  }
}

TEST(LocalCoordinates, RoundTripFromTangent) {
  // Every tangent with rotation and direction below half a turn, hence directions beyond 90 deg too.
  RandomStream rng({.seed = 1, .purpose = 57});
  for (int i = 0; i < 300; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const double turn = rng.Uniform(0.0, 3.1), azimuth = rng.Uniform(0.0, 2.0 * kPi);
    Vector5d tangent;
    tangent.head<3>() = rng.Uniform(0.0, 3.1) * RandomDirection(rng);
    tangent.tail<2>() << turn * std::cos(azimuth), turn * std::sin(azimuth);
    const Vector5d back = LocalCoordinates(pose, Retract(pose, tangent));
    EXPECT_LT((back - tangent).norm(), 1e-11) << tangent.transpose();
  }
}

TEST(LocalCoordinates, RoundTripFromAnyPose) {
  RandomStream rng({.seed = 1, .purpose = 58});
  int num_beyond_90_deg = 0;
  for (int i = 0; i < 300; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0), other = RandomPose(rng, 180.0);
    num_beyond_90_deg += pose.t.dot(other.t) < 0.0;
    ExpectSamePose(Retract(pose, LocalCoordinates(pose, other)), other, 1e-12);
  }
  EXPECT_GT(num_beyond_90_deg, 50);
}

TEST(LocalCoordinates, OppositeAndNearlyOppositeDirections) {
  RandomStream rng({.seed = 1, .purpose = 59});
  for (const double offset : {0.0, 1e-15, 1e-12, 1e-8, 1e-4}) {
    const RelativePose pose = RandomPose(rng, 180.0);
    RelativePose other = pose;
    other.t = (-pose.t + offset * DirectionBasis(pose.t).col(1)).normalized();
    const Vector5d local = LocalCoordinates(pose, other);
    EXPECT_NEAR(local.tail<2>().norm(), kPi - offset, 1e-12);
    ExpectSamePose(Retract(pose, local), other, 1e-12);
  }
}

TEST(LocalCoordinates, LengthsAreTheAngles) {
  RandomStream rng({.seed = 1, .purpose = 60});
  for (int i = 0; i < 100; ++i) {
    const RelativePose a = RandomPose(rng, 180.0), b = RandomPose(rng, 180.0);
    const Vector5d local = LocalCoordinates(a, b);
    EXPECT_NEAR(local.head<3>().norm(), RotationAngleBetween(a.R, b.R), 1e-12);
    EXPECT_NEAR(local.tail<2>().norm(), AngleBetween(a.t, b.t), 1e-12);
  }
}

// The great circle from a to b leaves a in the direction of b's coordinates around a, and arrives at b in the
// direction opposite to a's around b.
TEST(TransportTangent, KeepsTheDirectionOfAGreatCircle) {
  RandomStream rng({.seed = 1, .purpose = 2814});
  int num_bases_differ = 0;
  for (int i = 0; i < 300; ++i) {
    const RelativePose a = RandomPose(rng, 180.0);
    Vector5d near;
    for (double& x : near) x = 0.01 * rng.Normal();
    const RelativePose b = i % 2 == 0 ? RandomPose(rng, 180.0) : Retract(a, near);
    const Matrix5d transport = TransportTangent(a, b);
    EXPECT_LT((transport * transport.transpose() - Matrix5d::Identity()).norm(), 1e-10);
    EXPECT_GT(transport.determinant(), 0.0);
    EXPECT_EQ((transport.topLeftCorner<3, 3>() - Eigen::Matrix3d::Identity()).norm(), 0.0);
    const Vector5d leaves = LocalCoordinates(a, b), arrives = -LocalCoordinates(b, a);
    EXPECT_LT((transport * leaves - arrives).tail<2>().norm(), 1e-10 * leaves.tail<2>().norm() + 1e-10);
    num_bases_differ += (transport - Matrix5d::Identity()).norm() > 0.5;
  }
  EXPECT_GT(num_bases_differ, 50);
  const RelativePose pose = RandomPose(rng, 180.0), opposite{pose.R, -pose.t};
  EXPECT_TRUE(TransportTangent(pose, opposite).allFinite());
}

TEST(Angles, ByHand) {
  EXPECT_EQ(AngleBetween(Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX()), 0.0);
  EXPECT_NEAR(AngleBetween(Eigen::Vector3d::UnitX(), 5.0 * Eigen::Vector3d::UnitY()), kPi / 2, 1e-15);
  EXPECT_NEAR(AngleBetween(Eigen::Vector3d::UnitX(), -Eigen::Vector3d::UnitX()), kPi, 1e-15);
  // Small angles keep their digits (an arc cosine would return 0 or 1.5e-8).
  EXPECT_NEAR(AngleBetween(Eigen::Vector3d::UnitX(), {1.0, 1e-9, 0.0}), 1e-9, 1e-22);
  const Eigen::Matrix3d R = RotationFromVector({0.3, -0.2, 0.9});
  EXPECT_NEAR(RotationAngleBetween(R, R), 0.0, 1e-15);
  EXPECT_NEAR(RotationAngleBetween(RotationFromVector({0.0, 0.0, 1e-9}) * R, R), 1e-9, 1e-15);
  EXPECT_NEAR(RotationAngleBetween(RotationFromVector({0.0, 2.5, 0.0}) * R, R), 2.5, 1e-14);
}

Eigen::Matrix<double, 7, 1> QuaternionAndTranslation(const RelativePose& pose) {
  const Eigen::Quaterniond q(pose.R);
  Eigen::Matrix<double, 7, 1> p;
  p << q.w(), q.vec(), pose.t;
  return p;
}

TEST(QuaternionAndTranslation, JacobianHasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 61});
  for (int i = 0; i < 50; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const Eigen::Matrix<double, 7, 1> here = QuaternionAndTranslation(pose);
    const auto p = [&](const Eigen::VectorXd& tangent) -> Eigen::VectorXd {
      Eigen::Matrix<double, 7, 1> there = QuaternionAndTranslation(Retract(pose, tangent));
      if (there.head<4>().dot(here.head<4>()) < 0.0) there.head<4>() *= -1.0;  // q and -q are one rotation
      return there;
    };
    EXPECT_JACOBIAN_NEAR(QuaternionAndTranslationJacobian(pose), NumericJacobian(p, Vector5d::Zero(), 1e-3),
                         1e-10);
  }
}

}  // namespace
}  // namespace rcme
