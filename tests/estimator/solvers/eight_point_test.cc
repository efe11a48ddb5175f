#include "estimator/solvers/eight_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "estimator/geometry/sampson.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

struct EightRays {
  EightPoint::Rays first, second;
};

EightRays ComputeEightRays(const MotionProblem& problem) {
  EightRays rays;
  for (size_t k = 0; k < 8; ++k) {
    rays.first[k] = problem.camera1.Ray(problem.matches[k].x1_px);
    rays.second[k] = problem.camera2.Ray(problem.matches[k].x2_px);
  }
  return rays;
}

std::optional<LinearModel> Solve(const MotionProblem& problem) {
  const EightRays rays = ComputeEightRays(problem);
  return EightPoint::Solve(rays.first, rays.second);
}

// How far the two lines through a and b are apart (unit vectors, either sign).
double DistanceOfNullVectors(const Vector9d& a, const Vector9d& b) {
  return std::min((a - b).norm(), (a + b).norm());
}

// M (8 x 9), row k = kron(x2, x1)'.
Eigen::MatrixXd MakeConstraintRows(const EightRays& rays) {
  Eigen::MatrixXd M(8, 9);
  for (int k = 0; k < 8; ++k) {
    M.row(k) =
        Vectorize(rays.second[static_cast<size_t>(k)] * rays.first[static_cast<size_t>(k)].transpose());
  }
  return M;
}

// Smallest over largest singular value of M: the sample's conditioning.
double ReciprocalCondition(const EightRays& rays) {
  const Eigen::VectorXd s = SingularValues(MakeConstraintRows(rays));
  return s(7) / s(0);
}

// Hartley's way (Hartley & Zisserman, algorithm 11.1 up to rank 2): centroid to zero, mean distance sqrt(2),
// SVD.
Vector9d NullVectorInHartleyCoordinates(const EightRays& rays) {
  const auto normalization = [](const EightPoint::Rays& points) {
    Eigen::Vector2d centroid = Eigen::Vector2d::Zero();
    for (const Eigen::Vector3d& point : points) centroid += point.head<2>() / 8.0;
    double mean_distance = 0.0;
    for (const Eigen::Vector3d& point : points) mean_distance += (point.head<2>() - centroid).norm() / 8.0;
    const double scale = std::sqrt(2.0) / mean_distance;
    Eigen::Matrix3d T;
    T << scale, 0.0, -scale * centroid.x(), 0.0, scale, -scale * centroid.y(), 0.0, 0.0, 1.0;
    return T;
  };
  const Eigen::Matrix3d T1 = normalization(rays.first), T2 = normalization(rays.second);
  Eigen::MatrixXd M(8, 9);
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d a = T1 * rays.first[static_cast<size_t>(k)];
    const Eigen::Vector3d b = T2 * rays.second[static_cast<size_t>(k)];
    for (int row = 0; row < 3; ++row) M.block<1, 3>(k, 3 * row) = b(row) * a.transpose();
  }
  const Vector9d null_vector = NullVector(M);
  Eigen::Matrix3d F_normalized;
  for (int row = 0; row < 3; ++row) F_normalized.row(row) = null_vector.segment<3>(3 * row).transpose();
  const Eigen::Matrix3d F = T2.transpose() * F_normalized * T1;
  Vector9d f;
  for (int row = 0; row < 3; ++row) f.segment<3>(3 * row) = F.row(row).transpose();
  return f.normalized();
}

TEST(EightPoint, RecoversTheEssentialMatrixFromExactMatches) {
  RandomStream rng({.seed = 1, .purpose = 100});
  for (int i = 0; i < 200; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.max_rotation_deg = 40.0});
    const std::optional<LinearModel> model = Solve(random.problem);
    ASSERT_TRUE(model);
    EXPECT_NEAR(model->f.norm(), 1.0, 1e-14);
    const Vector9d truth = Vectorize(EssentialFromPose(random.pose_true)) / std::sqrt(2.0);
    EXPECT_LT(DistanceOfNullVectors(model->f, truth),
              1e-14 / ReciprocalCondition(ComputeEightRays(random.problem)));
  }
}

TEST(EightPoint, NullVectorIsHartleys) {
  // Also with noise: eight points have one null vector, whatever the coordinates.
  RandomStream rng({.seed = 1, .purpose = 101});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.max_rotation_deg = 40.0});
    AddNoise(1.0, rng, &random.problem);
    const EightRays rays = ComputeEightRays(random.problem);
    const std::optional<LinearModel> model = EightPoint::Solve(rays.first, rays.second);
    ASSERT_TRUE(model);
    EXPECT_LT(DistanceOfNullVectors(model->f, NullVectorInHartleyCoordinates(rays)),
              1e-13 / ReciprocalCondition(rays));
  }
}

TEST(EightPoint, AIsAnOrthonormalBasisOfTheComplementOfF) {
  RandomStream rng({.seed = 1, .purpose = 102});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(1.0, rng, &random.problem);
    const std::optional<LinearModel> model = Solve(random.problem);
    ASSERT_TRUE(model);
    const Eigen::MatrixXd A = model->A, f = model->f;
    EXPECT_LT(Multiply(A.transpose(), f).norm(), 1e-14);
    EXPECT_LT((Multiply(A.transpose(), A) - Eigen::MatrixXd::Identity(8, 8)).norm(), 1e-13);
    EXPECT_LT(Multiply(f.transpose(), model->G).norm(), 1e-13 * model->G.norm());
  }
}

TEST(EightPoint, GInvertsTheConstraintsOnTheComplement) {
  // M G = I and G = A (M A)^-1, by an inverse that uses no QR.
  RandomStream rng({.seed = 1, .purpose = 103});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(1.0, rng, &random.problem);
    const EightRays rays = ComputeEightRays(random.problem);
    const std::optional<LinearModel> model = EightPoint::Solve(rays.first, rays.second);
    ASSERT_TRUE(model);
    const Eigen::MatrixXd M = MakeConstraintRows(rays), A = model->A;
    const double tolerance = 1e-14 / ReciprocalCondition(rays);
    EXPECT_LT((Multiply(M, model->G) - Eigen::MatrixXd::Identity(8, 8)).norm(), tolerance);
    const Eigen::MatrixXd G = Multiply(A, Inverse(Multiply(M, A)));
    EXPECT_LT((model->G - G).norm(), tolerance * G.norm());
  }
}

TEST(EightPoint, GHasANumericTwin) {
  // df/dX of all 32 pixel coordinates: -G dg/dX, dg_k/dX_k the gradient of constraint k in pixels.
  RandomStream rng({.seed = 1, .purpose = 104});
  int num_compared = 0;
  for (int i = 0; i < 100; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(1.0, rng, &random.problem);
    const double condition = ReciprocalCondition(ComputeEightRays(random.problem));
    if (condition < 3e-4) continue;  // there the step would have to be too small for double precision
    const std::optional<LinearModel> model = Solve(random.problem);
    ASSERT_TRUE(model);
    const auto f_of = [&](const Eigen::VectorXd& X) -> Eigen::VectorXd {
      MotionProblem moved = random.problem;
      for (int k = 0; k < 8; ++k) {
        moved.matches[static_cast<size_t>(k)] = {X.segment<2>(4 * k), X.segment<2>(4 * k + 2)};
      }
      const Vector9d f = Solve(moved).value().f;
      return f.dot(model->f) < 0.0 ? Eigen::VectorXd(-f) : Eigen::VectorXd(f);
    };
    const Eigen::Matrix3d F =
        FundamentalFromEssential(Matricize(model->f), random.problem.camera1, random.problem.camera2);
    Eigen::VectorXd X(32);
    Eigen::MatrixXd dg_dX = Eigen::MatrixXd::Zero(8, 32);
    for (int k = 0; k < 8; ++k) {
      const Correspondence& match = random.problem.matches[static_cast<size_t>(k)];
      X.segment<4>(4 * k) << match.x1_px, match.x2_px;
      dg_dX.block<1, 4>(k, 4 * k) = EvaluateConstraint(F, match).gradient.transpose();
    }
    EXPECT_JACOBIAN_NEAR(Multiply(-model->G, dg_dX), NumericJacobian(f_of, X, 20.0 * condition), 1e-5);
    ++num_compared;
  }
  EXPECT_GT(num_compared, 30);
}

TEST(EightPoint, RepeatedPointsAreDegenerate) {
  RandomStream rng({.seed = 1, .purpose = 105});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(1.0, rng, &random.problem);
    ASSERT_TRUE(Solve(random.problem));
    random.problem.matches[6] = random.problem.matches[2];
    EXPECT_FALSE(Solve(random.problem));
  }
}

TEST(EightPoint, PointsOnOneSpaceLineAreDegenerate) {
  RandomStream rng({.seed = 1, .purpose = 106});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    const Eigen::Vector3d a = random.points_in_cam1[0], b = random.points_in_cam1[1];
    for (int k = 0; k < 8; ++k) {
      const Eigen::Vector3d point = a + (k / 7.0) * (b - a);
      random.problem.matches[static_cast<size_t>(k)] =
          ProjectToBoth(point, random.pose_true, random.problem.camera1, random.problem.camera2);
    }
    EXPECT_FALSE(Solve(random.problem));
  }
}

TEST(EightPoint, CollinearImagePointsAreDegenerateEvenWithNoiseInTheOtherImage) {
  RandomStream rng({.seed = 1, .purpose = 107});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(5.0, rng, &random.problem);
    for (Correspondence& match : random.problem.matches) match.x1_px.y() = 0.5 * match.x1_px.x() + 20.0;
    EXPECT_FALSE(Solve(random.problem));
  }
}

TEST(EightPoint, PureRotationIsDegenerate) {
  RandomStream rng({.seed = 1, .purpose = 108});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    for (size_t k = 0; k < 8; ++k) {
      // Very far away, the translation is nothing.
      const Eigen::Vector3d turned = random.pose_true.R * random.points_in_cam1[k];
      random.problem.matches[k].x2_px = random.problem.camera2.Project(turned);
    }
    EXPECT_FALSE(Solve(random.problem));
  }
}

TEST(EightPoint, CoplanarScenePointsAreDegenerate) {
  RandomStream rng({.seed = 1, .purpose = 109});
  for (int i = 0; i < 50; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    const Eigen::Vector3d normal(0.3 * rng.Normal(), 0.3 * rng.Normal(), 1.0);
    for (size_t k = 0; k < 8; ++k) {
      const Eigen::Vector3d ray = random.points_in_cam1[k] / random.points_in_cam1[k].z();
      const Eigen::Vector3d point = 8.0 / normal.dot(ray) * ray;  // on normal' X = 8
      random.problem.matches[k] =
          ProjectToBoth(point, random.pose_true, random.problem.camera1, random.problem.camera2);
    }
    EXPECT_FALSE(Solve(random.problem));
  }
}

TEST(EightPoint, BadNumbersGiveNoModel) {
  RandomStream rng({.seed = 1, .purpose = 110});
  const RandomProblem random = MakeRandomProblem(rng);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MotionProblem problem = random.problem;
    problem.matches[3].x2_px.y() = bad;
    EXPECT_FALSE(Solve(problem));
  }
}

}  // namespace
}  // namespace rcme
