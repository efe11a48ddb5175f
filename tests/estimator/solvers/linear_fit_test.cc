#include "estimator/solvers/linear_fit.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

#include "estimator/geometry/sampson.h"
#include "estimator/solvers/eight_point.h"
#include "tests/test_support/linear_algebra.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

struct Rays {
  std::vector<Eigen::Vector3d> first, second;
};

Rays ComputeRays(const MotionProblem& problem) {
  Rays rays;
  for (const Correspondence& match : problem.matches) {
    rays.first.push_back(problem.camera1.Ray(match.x1_px));
    rays.second.push_back(problem.camera2.Ray(match.x2_px));
  }
  return rays;
}

std::optional<LinearFit> Fit(const MotionProblem& problem) {
  const Rays rays = ComputeRays(problem);
  return FitLinear(rays.first, rays.second);
}

// The rows kron(x2, x1), written out.
Eigen::MatrixXd MakeDesignMatrix(const Rays& rays) {
  Eigen::MatrixXd M(rays.first.size(), 9);
  for (size_t k = 0; k < rays.first.size(); ++k) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        M(static_cast<Eigen::Index>(k), 3 * row + column) = rays.second[k](row) * rays.first[k](column);
      }
    }
  }
  return M;
}

double DistanceOfLines(const Vector9d& a, const Vector9d& b) {
  return std::min((a - b).norm(), (a + b).norm());
}

TEST(FitLinear, EqualsEightPointAtEight) {
  RandomStream rng({.seed = 1, .purpose = 900});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(1.0, rng, &random.problem);
    const Rays rays = ComputeRays(random.problem);
    EightPoint::Rays first, second;
    std::copy_n(rays.first.begin(), 8, first.begin());
    std::copy_n(rays.second.begin(), 8, second.begin());
    const LinearModel eight = EightPoint::Solve(first, second).value();
    const LinearFit fit = Fit(random.problem).value();
    const double tolerance = 1e-13 / fit.conditioning;
    EXPECT_LT(DistanceOfLines(fit.f, eight.f), tolerance);
    // G does not depend on the sign of f or on the choice of the basis A.
    EXPECT_LT((fit.G - eight.G).norm(), tolerance * eight.G.norm());
    EXPECT_LT((Multiply(fit.A, fit.A.transpose()) - Multiply(eight.A, eight.A.transpose())).norm(),
              tolerance);
  }
}

TEST(FitLinear, IsTheSmallestEigenvectorAndThePseudoInverse) {
  // Another route to both: eigenvectors of M'M, whose accuracy is the square of ours, and the normal
  // equations (A'M'M A)^-1 A'M'.
  RandomStream rng({.seed = 1, .purpose = 901});
  for (const int m : {9, 12, 50}) {
    for (int i = 0; i < 50; ++i) {
      RandomProblem random = MakeRandomProblem(rng, {.num_matches = m});
      AddNoise(1.0, rng, &random.problem);
      const LinearFit fit = Fit(random.problem).value();
      const Eigen::MatrixXd M = MakeDesignMatrix(ComputeRays(random.problem));
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(Multiply(M.transpose(), M));
      const double tolerance = 1e-13 / (fit.conditioning * fit.conditioning);
      EXPECT_LT(DistanceOfLines(fit.f, eigen.eigenvectors().col(0)), tolerance);
      EXPECT_NEAR(fit.conditioning, std::sqrt(eigen.eigenvalues()(1) / eigen.eigenvalues()(8)),
                  tolerance * fit.conditioning);
      const Eigen::MatrixXd A = fit.A, MA = Multiply(M, A);
      const Eigen::MatrixXd G = Multiply(A, Multiply(Inverse(Multiply(MA.transpose(), MA)), MA.transpose()));
      EXPECT_LT((fit.G - G).norm(), tolerance * G.norm());
      EXPECT_NEAR(fit.f.norm(), 1.0, 1e-14);
      EXPECT_LT(Multiply(A.transpose(), fit.f).norm(), 1e-14);
      EXPECT_LT((Multiply(A.transpose(), A) - Eigen::MatrixXd::Identity(8, 8)).norm(), 1e-13);
    }
  }
}

TEST(FitLinear, RecoversTheEssentialMatrixFromExactMatches) {
  RandomStream rng({.seed = 1, .purpose = 902});
  for (const int m : {8, 20, 100}) {
    for (int i = 0; i < 50; ++i) {
      const RandomProblem random = MakeRandomProblem(rng, {.num_matches = m, .max_rotation_deg = 40.0});
      const LinearFit fit = Fit(random.problem).value();
      const Vector9d truth = Vectorize(EssentialFromPose(random.pose_true)) / std::sqrt(2.0);
      EXPECT_LT(fit.LocalCoordinates(truth).norm(), 1e-14 / fit.conditioning);
    }
  }
}

// df/dX of all 4 m pixel coordinates by finite differences, and -G dg/dX.
struct Jacobians {
  Eigen::MatrixXd analytic, numeric;
};

Jacobians ComputeJacobians(const MotionProblem& problem, double step_px) {
  const LinearFit fit = Fit(problem).value();
  const auto m = static_cast<Eigen::Index>(problem.matches.size());
  const auto f_of = [&](const Eigen::VectorXd& X) -> Eigen::VectorXd {
    MotionProblem moved = problem;
    for (Eigen::Index k = 0; k < m; ++k) {
      moved.matches[static_cast<size_t>(k)] = {X.segment<2>(4 * k), X.segment<2>(4 * k + 2)};
    }
    const Vector9d f = Fit(moved).value().f;
    return f.dot(fit.f) < 0.0 ? Eigen::VectorXd(-f) : Eigen::VectorXd(f);
  };
  const Eigen::Matrix3d F = FundamentalFromEssential(Matricize(fit.f), problem.camera1, problem.camera2);
  Eigen::VectorXd X(4 * m);
  Eigen::MatrixXd dg_dX = Eigen::MatrixXd::Zero(m, 4 * m);
  for (Eigen::Index k = 0; k < m; ++k) {
    const Correspondence& match = problem.matches[static_cast<size_t>(k)];
    X.segment<4>(4 * k) << match.x1_px, match.x2_px;
    dg_dX.block<1, 4>(k, 4 * k) = EvaluateConstraint(F, match).gradient.transpose();
  }
  return {Multiply(-fit.G, dg_dX), NumericJacobian(f_of, X, step_px)};
}

TEST(FitLinear, GHasANumericTwinWhereThereIsNoResidual) {
  RandomStream rng({.seed = 1, .purpose = 903});
  for (const int m : {8, 9, 20, 60}) {
    int num_compared = 0;
    for (int i = 0; i < 20; ++i) {
      const RandomProblem random = MakeRandomProblem(rng, {.num_matches = m});
      const double conditioning = Fit(random.problem).value().conditioning;
      if (conditioning < 3e-4) continue;  // the step would have to be too small for double precision
      const Jacobians jacobians = ComputeJacobians(random.problem, 20.0 * conditioning);
      EXPECT_JACOBIAN_NEAR(jacobians.analytic, jacobians.numeric, 1e-5);
      ++num_compared;
    }
    EXPECT_GT(num_compared, 5) << m;
  }
}

TEST(FitLinear, GLeavesOutNoMoreThanTheResidual) {
  // With noise, the left-out term dM' (M f) grows in proportion to it: ten times the noise, about ten times
  // the error of the Jacobian. A wrong G would keep its error as the noise shrinks.
  RandomStream rng({.seed = 1, .purpose = 904});
  for (int i = 0; i < 10; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 30});
    const auto relative_error = [&](double sigma_px) {
      RandomStream noise({.seed = 1, .trial = static_cast<std::uint32_t>(i), .purpose = 905});
      MotionProblem noisy = random.problem;
      AddNoise(sigma_px, noise, &noisy);
      const Jacobians jacobians = ComputeJacobians(noisy, 20.0 * Fit(noisy).value().conditioning);
      return (jacobians.analytic - jacobians.numeric).norm() / jacobians.numeric.norm();
    };
    const double at_1 = relative_error(0.1), at_10 = relative_error(0.01);
    EXPECT_GT(at_1, 1e-5) << "nothing is left out: this compares rounding";
    EXPECT_NEAR(at_10 / at_1, 0.1, 0.05);
  }
}

TEST(FitLinear, LocalCoordinatesIgnoreTheSign) {
  RandomStream rng({.seed = 1, .purpose = 906});
  const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 12});
  const LinearFit fit = Fit(random.problem).value();
  const Vector8d small = Vector8d::LinSpaced(-0.02, 0.02);
  const Vector9d other = (fit.f + fit.A * small).normalized();
  const Vector8d expected = small / std::sqrt(1.0 + small.squaredNorm());
  EXPECT_LT((fit.LocalCoordinates(other) - expected).norm(), 1e-14);
  EXPECT_LT((fit.LocalCoordinates(-other) - expected).norm(), 1e-14);
}

TEST(FitLinear, DegenerateSamplesAndBadNumbersGiveNothing) {
  RandomStream rng({.seed = 1, .purpose = 907});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
  ASSERT_TRUE(Fit(random.problem));
  MotionProblem repeated = random.problem;  // seven different points
  for (size_t k = 7; k < 20; ++k) repeated.matches[k] = repeated.matches[k % 7];
  EXPECT_FALSE(Fit(repeated));
  MotionProblem collinear = random.problem;
  for (Correspondence& match : collinear.matches) match.x1_px.y() = 0.5 * match.x1_px.x() + 20.0;
  EXPECT_FALSE(Fit(collinear));
  MotionProblem too_few = random.problem;
  too_few.matches.resize(7);
  EXPECT_FALSE(Fit(too_few));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MotionProblem problem = random.problem;
    problem.matches[3].x2_px.y() = bad;
    EXPECT_FALSE(Fit(problem));
  }
}

}  // namespace
}  // namespace rcme
