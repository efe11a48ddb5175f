#include "estimator/uncertainty/svd_differential.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>

#include "estimator/uncertainty/motion_covariance.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

EssentialProjection ComputeProjection(const Vector9d& f) { return ProjectToEssential(Matricize(f)); }

// A unit vector about 0.2 from an essential matrix.
Vector9d NoisyF(RandomStream& rng) {
  Vector9d noise;
  for (double& x : noise) x = 0.07 * rng.Normal();
  return (Vectorize(EssentialFromPose(RandomPose(rng, 180.0))) / std::sqrt(2.0) + noise).normalized();
}

// Where f moves `pose`, one of its four motions, in the pose's own tangent.
auto MotionNear(const RelativePose& pose) {
  return [pose](const Eigen::VectorXd& f) -> Eigen::VectorXd {
    Vector5d nearest = Vector5d::Constant(10.0);
    for (const RelativePose& moved : PosesFromEssential(ComputeProjection(f))) {
      const Vector5d tangent = LocalCoordinates(pose, moved);
      if (tangent.norm() < nearest.norm()) nearest = tangent;
    }
    return nearest;
  };
}

TEST(MotionJacobianBySvd, IsMotionJacobianAtAnEssentialMatrix) {
  // The singular values are equal there, and U and V arbitrary up to a common turn. Both signs of f.
  RandomStream rng({.seed = 1, .purpose = 240});
  for (int i = 0; i < 100; ++i) {
    const Vector9d e = Vectorize(EssentialFromPose(RandomPose(rng, 180.0))) / std::sqrt(2.0);
    for (const Vector9d& f : {e, Vector9d(-e)}) {
      const EssentialProjection projection = ComputeProjection(f);
      for (const RelativePose& pose : PosesFromEssential(projection)) {
        const double sign = Vectorize(EssentialFromPose(pose)).dot(f) > 0.0 ? 1.0 : -1.0;
        EXPECT_JACOBIAN_NEAR(MotionJacobianBySvd(projection, pose), sign * MotionJacobian(pose), 1e-13);
      }
    }
  }
}

TEST(MotionJacobianBySvd, HasANumericTwinAwayFromTheEssentialMatrices) {
  // All four motions, determinants of both signs, and far enough for MotionJacobian to be another matrix.
  RandomStream rng({.seed = 1, .purpose = 241});
  int num_positive = 0, num_compared = 0;
  double least_difference = 1.0;
  for (int i = 0; i < 100; ++i) {
    const Vector9d f = NoisyF(rng);
    const EssentialProjection projection = ComputeProjection(f);
    const double gap = projection.singular_values(1) - std::abs(projection.singular_values(2));
    if (gap < 0.1) continue;  // there the step would have to be too small for double precision
    num_positive += projection.singular_values(2) > 0.0 ? 1 : 0;
    ++num_compared;
    for (const RelativePose& pose : PosesFromEssential(projection)) {
      const Eigen::Matrix<double, 5, 9> jacobian = MotionJacobianBySvd(projection, pose);
      EXPECT_JACOBIAN_NEAR(jacobian, NumericJacobian(MotionNear(pose), f, 1e-2 * gap), 1e-6);
      const double sign = Vectorize(EssentialFromPose(pose)).dot(f) > 0.0 ? 1.0 : -1.0;
      least_difference =
          std::min(least_difference, (jacobian - sign * MotionJacobian(pose)).norm() / jacobian.norm());
    }
  }
  EXPECT_GT(num_compared, 80);
  EXPECT_GT(num_positive, 20);
  EXPECT_LT(num_positive, num_compared - 20);
  EXPECT_GT(least_difference, 0.01);
}

TEST(MotionJacobianBySvd, DoesNotSeeTheScaleOfF) {
  RandomStream rng({.seed = 1, .purpose = 242});
  for (int i = 0; i < 50; ++i) {
    const Vector9d f = NoisyF(rng);
    const EssentialProjection projection = ComputeProjection(f);
    for (const RelativePose& pose : PosesFromEssential(projection)) {
      const Eigen::Matrix<double, 5, 9> jacobian = MotionJacobianBySvd(projection, pose);
      EXPECT_LT((jacobian * f).norm(), 1e-13 * jacobian.norm());
    }
  }
}

TEST(MotionJacobianBySvd, IsInfiniteWhereTheDirectionIsNotDetermined) {
  const EssentialProjection projection{Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity(),
                                       Eigen::Vector3d(0.8, 0.3, 0.3)};
  EXPECT_FALSE(MotionJacobianBySvd(projection, PosesFromEssential(projection)[0]).allFinite());
}

}  // namespace
}  // namespace rcme
