#include "estimator/geometry/essential_matrix.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

Eigen::Matrix3d RandomMatrix(RandomStream& rng) {
  Eigen::Matrix3d matrix;
  for (double& x : matrix.reshaped()) x = rng.Normal();
  return matrix;
}

TEST(Vectorize, GoesRowByRowAndBack) {
  Eigen::Matrix3d matrix;
  matrix << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  const Vector9d vector = Vectorize(matrix);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(vector(i), i + 1.0);
  EXPECT_EQ(Matricize(vector), matrix);
}

TEST(EssentialFromPose, SatisfiesTheEpipolarConstraintOfProjectedPoints) {
  RandomStream rng({.seed = 1, .purpose = 70});
  for (int i = 0; i < 50; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 10, .max_rotation_deg = 40.0});
    const Eigen::Matrix3d E = EssentialFromPose(random.pose_true);
    EXPECT_NEAR(E.norm(), std::sqrt(2.0), 1e-14);
    const Eigen::Matrix3d F = FundamentalFromEssential(E, random.problem.camera1, random.problem.camera2);
    for (const Correspondence& match : random.problem.matches) {
      const Eigen::Vector3d ray1 = random.problem.camera1.Ray(match.x1_px);
      const Eigen::Vector3d ray2 = random.problem.camera2.Ray(match.x2_px);
      EXPECT_NEAR(ray2.dot(E * ray1), 0.0, 1e-14);
      EXPECT_NEAR(match.x2_px.homogeneous().dot(F * match.x1_px.homogeneous()), 0.0, 1e-13);
      // The same point one pixel away is not zero: the check has a scale.
      EXPECT_GT(std::abs((F * match.x1_px.homogeneous()).head<2>().norm()), 1e-7);
    }
  }
}

TEST(EssentialFromPose, HasTwoEqualSingularValuesAndAZero) {
  RandomStream rng({.seed = 1, .purpose = 71});
  const Eigen::Matrix3d E = EssentialFromPose(RandomPose(rng, 180.0));
  const Eigen::Vector3d s = SingularValues(E);
  EXPECT_LT((s - Eigen::Vector3d(1.0, 1.0, 0.0)).norm(), 1e-14);
}

TEST(FundamentalFromEssential, IsBilinearInRays) {
  // x2' F x1 = ray2' E ray1 for any pixels and any matrix.
  RandomStream rng({.seed = 1, .purpose = 72});
  const Camera camera1 = TestCamera1(), camera2 = TestCamera2();
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d matrix = RandomMatrix(rng);
    const Eigen::Vector2d x1(rng.Uniform(0, 640), rng.Uniform(0, 480));
    const Eigen::Vector2d x2(rng.Uniform(0, 800), rng.Uniform(0, 600));
    const Eigen::Matrix3d F = FundamentalFromEssential(matrix, camera1, camera2);
    EXPECT_NEAR(x2.homogeneous().dot(F * x1.homogeneous()), camera2.Ray(x2).dot(matrix * camera1.Ray(x1)),
                1e-12);
  }
}

TEST(EssentialTangent, HasANumericTwin) {
  RandomStream rng({.seed = 1, .purpose = 73});
  for (int i = 0; i < 50; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const auto essential = [&](const Eigen::VectorXd& tangent) -> Eigen::VectorXd {
      return Vectorize(EssentialFromPose(Retract(pose, tangent)));
    };
    Eigen::MatrixXd analytic(9, 5);
    const std::array<Eigen::Matrix3d, 5> tangent = EssentialTangent(pose);
    for (int k = 0; k < 5; ++k) analytic.col(k) = Vectorize(tangent[static_cast<size_t>(k)]);
    EXPECT_JACOBIAN_NEAR(analytic, NumericJacobian(essential, Vector5d::Zero(), 1e-3), 1e-10);
  }
}

TEST(EssentialTangent, IsNormalToEAndHasRankFive) {
  RandomStream rng({.seed = 1, .purpose = 74});
  for (int i = 0; i < 50; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const Vector9d e = Vectorize(EssentialFromPose(pose));
    Eigen::MatrixXd tangent(9, 5);
    const std::array<Eigen::Matrix3d, 5> matrices = EssentialTangent(pose);
    for (int k = 0; k < 5; ++k) tangent.col(k) = Vectorize(matrices[static_cast<size_t>(k)]);
    EXPECT_LT((tangent.transpose() * e).norm(), 1e-14);
    EXPECT_GT(SingularValues(tangent)(4), 0.1);
  }
}

TEST(ProjectToEssential, FactorsAreRotationsAndRebuildTheMatrix) {
  RandomStream rng({.seed = 1, .purpose = 75});
  for (int i = 0; i < 50; ++i) {
    const Eigen::Matrix3d matrix = RandomMatrix(rng);
    const EssentialProjection p = ProjectToEssential(matrix);
    EXPECT_LT((p.U.transpose() * p.U - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_LT((p.V.transpose() * p.V - Eigen::Matrix3d::Identity()).norm(), 1e-13);
    EXPECT_NEAR(p.U.determinant(), 1.0, 1e-13);
    EXPECT_NEAR(p.V.determinant(), 1.0, 1e-13);
    EXPECT_GE(p.singular_values(0), p.singular_values(1));
    EXPECT_GE(p.singular_values(1), std::abs(p.singular_values(2)));
    EXPECT_LT((p.U * p.singular_values.asDiagonal() * p.V.transpose() - matrix).norm(), 1e-13);
    EXPECT_GT(p.singular_values(2) * matrix.determinant(), 0.0);
  }
}

// The distance of `matrix` from the nearest positive multiple of E.
double DistanceUpToScale(const Eigen::Matrix3d& matrix, const Eigen::Matrix3d& E) {
  const double scale = Vectorize(matrix).dot(Vectorize(E)) / E.squaredNorm();
  return (matrix - scale * E).norm();
}

TEST(ProjectToEssential, IsTheNearestEssentialMatrix) {
  // No essential matrix near or far is nearer: random motions, and small steps from the projection itself,
  // which would reveal a projection that is only close (a first-order error of 0.01 is lost in 1 + 1e-4).
  RandomStream rng({.seed = 1, .purpose = 76});
  for (int i = 0; i < 20; ++i) {
    const Eigen::Matrix3d matrix = EssentialFromPose(RandomPose(rng, 180.0)) + 0.3 * RandomMatrix(rng);
    const EssentialProjection p = ProjectToEssential(matrix);
    const Eigen::Matrix3d E = p.U * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal() * p.V.transpose();
    const double distance = DistanceUpToScale(matrix, E);
    EXPECT_GT(distance, 0.01) << "the matrix was essential already";
    for (int k = 0; k < 500; ++k) {
      EXPECT_GE(DistanceUpToScale(matrix, EssentialFromPose(RandomPose(rng, 180.0))), distance);
    }
    const RelativePose pose = PosesFromEssential(p)[0];
    const double sign = DistanceUpToScale(EssentialFromPose(pose), E) < 1e-9 ? 1.0 : -1.0;
    const auto squared_distance = [&](const Vector5d& step) {
      const double d = DistanceUpToScale(matrix, sign * EssentialFromPose(Retract(pose, step)));
      return d * d;
    };
    for (int k = 0; k < 5; ++k) {
      const double h = 1e-4;
      const double slope =
          (squared_distance(h * Vector5d::Unit(k)) - squared_distance(-h * Vector5d::Unit(k))) / (2.0 * h);
      EXPECT_NEAR(slope, 0.0, 1e-6) << "not stationary along tangent " << k;
      EXPECT_GT(squared_distance(0.01 * Vector5d::Unit(k)), distance * distance);
      EXPECT_GT(squared_distance(-0.01 * Vector5d::Unit(k)), distance * distance);
    }
  }
}

TEST(PosesFromEssential, ContainTheTruthForEitherSignOfE) {
  RandomStream rng({.seed = 1, .purpose = 77});
  for (int i = 0; i < 50; ++i) {
    const RelativePose truth = RandomPose(rng, 180.0);
    for (const double scale : {1.0, -1.0, 0.3, -20.0}) {
      double least = std::numeric_limits<double>::infinity();
      for (const RelativePose& pose :
           PosesFromEssential(ProjectToEssential(scale * EssentialFromPose(truth)))) {
        least = std::min(least, (pose.R - truth.R).norm() + (pose.t - truth.t).norm());
      }
      EXPECT_LT(least, 1e-13);
    }
  }
}

TEST(PosesFromEssential, AreFourDifferentMotionsOfOneE) {
  RandomStream rng({.seed = 1, .purpose = 78});
  const Eigen::Matrix3d E = EssentialFromPose(RandomPose(rng, 180.0));
  const std::array<RelativePose, 4> poses = PosesFromEssential(ProjectToEssential(E));
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(poses[i].R.determinant(), 1.0, 1e-14);
    EXPECT_LT((poses[i].R.transpose() * poses[i].R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
    EXPECT_NEAR(poses[i].t.norm(), 1.0, 1e-14);
    const Eigen::Matrix3d own = EssentialFromPose(poses[i]);
    EXPECT_LT(std::min((own - E).norm(), (own + E).norm()), 1e-13);
    for (size_t k = 0; k < i; ++k) {
      EXPECT_GT((poses[i].R - poses[k].R).norm() + (poses[i].t - poses[k].t).norm(), 1.0);
    }
  }
}

}  // namespace
}  // namespace rcme
