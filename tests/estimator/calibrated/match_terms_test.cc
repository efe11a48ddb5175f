#include "estimator/calibrated/match_terms.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "tests/test_support/numeric_jacobian.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

RandomProblem Noisy(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2700});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
  AddNoise(0.8, rng, &random.problem);
  return random;
}

TEST(MatchTerms, TheDerivativesAreThoseOfTheResidual) {
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const RandomProblem random = Noisy(trial);
    for (const Correspondence& match : random.problem.matches) {
      const Eigen::MatrixXd numeric = NumericJacobian(
          [&](const Eigen::VectorXd& tangent) {
            const RelativePose pose = Retract(random.pose_true, tangent);
            return Eigen::VectorXd::Constant(1, EvaluateMatch(random.problem, pose, match).residual);
          },
          Vector5d::Zero(), 1e-4);
      const Vector5d analytic = EvaluateMatch(random.problem, random.pose_true, match).derivative;
      EXPECT_JACOBIAN_NEAR(analytic.transpose(), numeric, 1e-6);
    }
  }
}

// Without noise a point's parallax lies within its epipolar plane: the angle of its triangle.
TEST(MatchTerms, DepthIsTheParallaxInUnitsOfItsNoise) {
  RandomStream rng({.seed = 1, .purpose = 2701});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
  random.problem.camera1.fy = random.problem.camera1.fx;
  random.problem.camera2 = random.problem.camera1;
  const MotionProblem& problem = random.problem;
  const double noise_rad = std::sqrt(2.0) * problem.sigma_px / problem.camera1.fx;
  RelativePose opposite = random.pose_true;
  opposite.t = -opposite.t;
  for (const Eigen::Vector3d& point : random.points_in_cam1) {
    const Correspondence match = ProjectToBoth(point, random.pose_true, problem.camera1, problem.camera2);
    const Eigen::Vector3d centre2 = -random.pose_true.R.transpose() * random.pose_true.t;
    const double parallax = AngleBetween(point, point - centre2);
    const MatchTerms ahead = EvaluateMatch(problem, random.pose_true, match);
    EXPECT_NEAR(ahead.depth, std::sin(parallax) / noise_rad, 1e-6);
    EXPECT_NEAR(ahead.mean_depth, ahead.depth, 1e-6);
    const MatchTerms behind = EvaluateMatch(problem, opposite, match);
    EXPECT_NEAR(behind.depth, -ahead.depth, 1e-6);
    EXPECT_NEAR(behind.residual, -ahead.residual, 1e-9);
  }
}

// p psi' - p (1 - p) psi^2 is the second derivative of -log density by u, and p psi the first.
TEST(MatchTerms, WeightAndCurvatureAreThoseOfTheLogDensity) {
  MixtureParameters m;
  m.scale = 1.3;
  m.inlier_ratio = 0.6;
  m.outlier_density = 2e-3;
  for (const double depth : {-4.0, -1.0, 0.0, 50.0}) {
    for (const double u : {-2.0, -0.7, 0.0, 0.2, 1.0, 3.0, 9.0}) {
      constexpr double h = 1e-3;
      const auto cost = [&](double at) { return -std::log(EvaluateDensity(m.scale * at, depth, m).density); };
      const double slope = (cost(u + h) - cost(u - h)) / (2.0 * h);
      const double bend = (cost(u + h) - 2.0 * cost(u) + cost(u - h)) / (h * h);
      const MatchDensity d = EvaluateDensity(m.scale * u, depth, m);
      EXPECT_NEAR(d.right * d.weight * u, slope, 1e-5) << u;
      EXPECT_NEAR(d.curvature, std::max(bend, 0.6 * d.right * d.weight), 1e-5) << u;
    }
  }
}

TEST(MatchTerms, CheiralityIsFlatInFrontAndFallsBehind) {
  EXPECT_EQ(CheiralityFactor(1e9), 1.0);
  EXPECT_EQ(CheiralityFactor(-1.0), 1.0);
  EXPECT_DOUBLE_EQ(CheiralityFactor(-2.0), 0.25);
  EXPECT_DOUBLE_EQ(CheiralityFactor(-4.0), 0.01);
}

// A camera that moves along x without turning, f = 100 px and sigma 1 px: the noise of the angle is sqrt(2) /
// 100. Of the rays a = (0, 0, 1) and b = (p, e, 1) the normals of the epipolar planes are (0, 1, 0) and (0,
// 1, -e) over sqrt(1 + e^2), and a x b = (-e, p, 0): z is the lesser of p / |b| and p / (|b| sqrt(1 + e^2))
// over that noise.
TEST(MatchTerms, DepthIsThatOfTheLessSureCamera) {
  const Camera camera{100.0, 100.0, 0.0, 0.0, 640, 480};
  const RelativePose pose{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()};
  constexpr double e = 0.5;
  for (const double p : {0.1, -0.1}) {
    const Correspondence match{{0.0, 0.0}, {100.0 * p, 100.0 * e}};
    const MatchTerms terms = EvaluateMatch({{match}, camera, camera, 1.0}, pose, match);
    const double of_a = p / std::sqrt(p * p + e * e + 1.0) * 100.0 / std::sqrt(2.0);
    const double of_b = of_a / std::sqrt(1.0 + e * e);
    EXPECT_NEAR(terms.depth, p > 0.0 ? of_b : of_a, 1e-9);
    EXPECT_NEAR(terms.mean_depth, 0.5 * (of_a + of_b), 1e-9);
  }
}

}  // namespace
}  // namespace rcme
