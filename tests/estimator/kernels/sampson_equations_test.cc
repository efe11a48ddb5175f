// The sums against the scalar Sampson distance and its numeric derivatives, on every instruction set.
#include "estimator/kernels/sampson_equations.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "estimator/geometry/sampson.h"
#include "estimator/noise_scale.h"
#include "estimator/refinement/sampson_equations.h"
#include "estimator/uncertainty/motion_covariance.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

class SampsonEquations : public OnEveryTarget {};

// Noise, a few wrong matches, and a motion a little beside the truth.
struct MotionBesideTruth {
  MotionProblem problem;
  RelativePose pose;
  std::vector<int> used;
};

MotionBesideTruth MakeMotionBesideTruth(int num_matches, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2610});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = num_matches});
  AddNoise(0.5, rng, &random.problem);
  Vector5d off;
  for (double& x : off) x = 0.002 * rng.Normal();
  MotionBesideTruth c{random.problem, Retract(random.pose_true, off), {}};
  for (int i = 0; i < num_matches; ++i) {
    if (rng.Uniform() < 0.1) c.problem.matches[static_cast<size_t>(i)].x2_px.y() += 30.0 * rng.Normal();
    if (rng.Uniform() < 0.8) c.used.push_back(i);
  }
  // Every other case says how noisy each match is.
  for (int i = 0; trial % 2 == 1 && i < num_matches; ++i)
    c.problem.noise_scale.push_back(rng.Uniform(0.4, 3.0));
  return c;
}

// Signed residuals r = g / |J| of the used matches in units of sigma.
Eigen::VectorXd Residuals(const MotionBesideTruth& c, const RelativePose& pose) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(pose), c.problem.camera1, c.problem.camera2);
  Eigen::VectorXd residuals(c.used.size());
  for (size_t k = 0; k < c.used.size(); ++k) {
    const auto i = static_cast<size_t>(c.used[k]);
    const EpipolarConstraint constraint = EvaluateConstraint(F, c.problem.matches[i]);
    const double sigma_px = c.problem.sigma_px * NoiseScaleAt(c.problem, i);
    residuals(static_cast<Eigen::Index>(k)) =
        constraint.g / (std::sqrt(constraint.squared_gradient()) * sigma_px);
  }
  return residuals;
}

double Rho(double r, Loss loss) {
  const double c2 = kCauchyScale * kCauchyScale;
  return loss == Loss::kCauchy ? c2 * std::log1p(r * r / c2) : r * r;
}
double Cost(const MotionBesideTruth& c, const RelativePose& pose, Loss loss) {
  double sum = 0.0;
  for (const double r : Residuals(c, pose)) sum += 0.5 * Rho(r, loss);
  return sum;
}
// max(psi', 0.7 rho'), by numeric differentiation of the loss.
double Curvature(double r, Loss loss) {
  const double h = 1e-3;
  const double second =
      (Rho(r + h, loss) - 2.0 * Rho(r, loss) + Rho(r - h, loss)) / (2.0 * h * h);  // of rho / 2
  const double first = (Rho(r + h, loss) - Rho(r - h, loss)) / (4.0 * h);          // psi
  return std::max(second, std::abs(r) > 1e-6 ? 0.7 * first / r : 0.7);
}

NormalEquations Linearize(const MotionBesideTruth& c, Loss loss) {
  const MatchBlocks matches(c.problem);
  return LinearizeSampson(matches, MakeMask(c.used, matches), c.pose, loss);
}

constexpr int kSampsonCounts[] = {5, 7, 8, 9, 16, 17, 63, 200};

TEST_F(SampsonEquations, CostAndGradientAreThoseOfTheScalarDistance) {
  for (const Loss loss : {Loss::kSquared, Loss::kCauchy}) {
    for (const int n : kSampsonCounts) {
      const MotionBesideTruth c = MakeMotionBesideTruth(n, static_cast<std::uint32_t>(n));
      const double cost = Cost(c, c.pose, loss);
      ASSERT_GT(cost, 0.0);
      const Eigen::MatrixXd numeric = NumericJacobian(
          [&](const Eigen::VectorXd& tangent) {
            return Eigen::VectorXd::Constant(1, Cost(c, Retract(c.pose, tangent), loss));
          },
          Vector5d::Zero(), 1e-5);
      Run([&] {
        const NormalEquations equations = Linearize(c, loss);
        EXPECT_NEAR(equations.cost, cost, 1e-11 * cost) << n;
        EXPECT_JACOBIAN_NEAR(equations.gradient.transpose(), numeric, 1e-6) << n;
      });
    }
  }
}

TEST_F(SampsonEquations, HessianSumsTheProductsOfTheDerivatives) {
  for (const Loss loss : {Loss::kSquared, Loss::kCauchy}) {
    for (const int n : kSampsonCounts) {
      const MotionBesideTruth c = MakeMotionBesideTruth(n, static_cast<std::uint32_t>(n));
      const Eigen::VectorXd residuals = Residuals(c, c.pose);
      const Eigen::MatrixXd r_p = NumericJacobian(
          [&](const Eigen::VectorXd& tangent) { return Residuals(c, Retract(c.pose, tangent)); },
          Vector5d::Zero(), 1e-5);
      Matrix5d expected = Matrix5d::Zero();
      for (Eigen::Index k = 0; k < residuals.size(); ++k) {
        expected += Curvature(residuals(k), loss) * r_p.row(k).transpose() * r_p.row(k);
      }
      Run([&] { EXPECT_JACOBIAN_NEAR(Linearize(c, loss).hessian, expected, 1e-5) << n; });
    }
  }
}

TEST_F(SampsonEquations, InformationIsTheInverseOfTheFirstOrderCovariance) {
  for (const int n : {8, 17, 200}) {
    MotionBesideTruth c = MakeMotionBesideTruth(n, static_cast<std::uint32_t>(n));
    c.problem.noise_scale.clear();
    std::vector<Correspondence> used;
    for (const int i : c.used) used.push_back(c.problem.matches[static_cast<size_t>(i)]);
    const std::optional<Matrix5d> cov =
        FirstOrderMotionCovariance(c.pose, c.problem.camera1, c.problem.camera2, used, c.problem.sigma_px);
    ASSERT_TRUE(cov);
    Run([&] {
      const MatchBlocks matches(c.problem);
      const Matrix5d information = SampsonInformation(matches, MakeMask(c.used, matches), c.pose);
      // Condition numbers reach 1e6.
      EXPECT_LT((information * *cov - Matrix5d::Identity()).norm(), 1e-8) << n;
    });
  }
}

// And of the reference, which shares no formula with them.
TEST_F(SampsonEquations, AreThoseOfTheReferenceWhereMatchesAreNotAlike) {
  for (const int n : {7, 17, 63}) {
    const MotionBesideTruth c = MakeMotionBesideTruth(n, static_cast<std::uint32_t>(n));
    ASSERT_EQ(c.problem.noise_scale.size(), static_cast<size_t>(n));
    for (const Loss loss : {Loss::kSquared, Loss::kCauchy}) {
      const NormalEquations expected = LinearizeSampson(c.problem, c.used, c.pose, loss);
      const Matrix5d information = SampsonInformation(c.problem, c.used, c.pose);
      Run([&] {
        const MatchBlocks matches(c.problem);
        const NormalEquations equations = Linearize(c, loss);
        EXPECT_NEAR(equations.cost, expected.cost, 1e-9 * expected.cost);
        EXPECT_JACOBIAN_NEAR(equations.gradient, expected.gradient, 1e-9);
        EXPECT_JACOBIAN_NEAR(equations.hessian, expected.hessian, 1e-9);
        EXPECT_JACOBIAN_NEAR(SampsonInformation(matches, MakeMask(c.used, matches), c.pose), information,
                             1e-9);
      });
    }
  }
}

TEST_F(SampsonEquations, CauchysCostStaysFiniteFarFromTheOptimum) {
  // Residuals of thousands of sigma: the logarithms must not be taken of a product that overflows.
  RandomStream rng({.seed = 1, .purpose = 2611});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 800});
  random.problem.sigma_px = 0.01;
  MotionBesideTruth c{random.problem, Retract(random.pose_true, Vector5d::Constant(0.2)), {}};
  for (int i = 0; i < 800; ++i) c.used.push_back(i);
  const double cost = Cost(c, c.pose, Loss::kCauchy);
  ASSERT_GT(Residuals(c, c.pose).cwiseAbs().mean(), 2000.0);
  Run([&] { EXPECT_NEAR(Linearize(c, Loss::kCauchy).cost, cost, 1e-11 * cost); });
}

TEST_F(SampsonEquations, MatchesOutsideTheMaskAddNothing) {
  MotionBesideTruth c = MakeMotionBesideTruth(40, 1);
  std::erase_if(c.used, [](int i) { return i % 8 == 3 || i >= 37; });
  for (const Loss loss : {Loss::kSquared, Loss::kCauchy}) {
    Run([&] {
      const NormalEquations before = Linearize(c, loss);
      MotionBesideTruth other = c;
      for (int i = 0; i < 40; ++i) {
        if (i % 8 == 3 || i >= 37) other.problem.matches[static_cast<size_t>(i)].x2_px.array() += 1e6;
      }
      const NormalEquations after = Linearize(other, loss);
      EXPECT_EQ(after.cost, before.cost);
      EXPECT_EQ(after.gradient, before.gradient);
      EXPECT_EQ(after.hessian, before.hessian);
    });
  }
}

}  // namespace
}  // namespace rcme
