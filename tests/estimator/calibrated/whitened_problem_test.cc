#include "estimator/calibrated/whitened_problem.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "estimator/geometry/sampson.h"
#include "stats/constants.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

struct Case {
  RandomProblem random;
  Eigen::Matrix2d shape;
};
Case MakeCase(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2991});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20});
  AddNoise(0.7, rng, &random.problem);
  const double size = 0.95 * std::sqrt(rng.Uniform()), angle = rng.Uniform(0.0, 2.0 * std::numbers::pi);
  const double b = size * std::cos(angle), c = size * std::sin(angle);
  Eigen::Matrix2d shape;
  shape << 1.0 + b, c, c, 1.0 - b;
  return {random, shape};
}

// T of a camera, from the definition: the rotation about the axis under which the rays of all matches turn.
Eigen::Matrix3d FindTurn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const double angle = std::atan2(to.y(), to.x()) - std::atan2(from.y(), from.x());
  return RotationFromVector({0.0, 0.0, angle});
}
struct Turns {
  Eigen::Matrix3d of_camera1, of_camera2;
};
Turns FindTurns(const MotionProblem& problem, const MotionProblem& whitened) {
  const Correspondence &match = problem.matches[0], &other = whitened.matches[0];
  return {FindTurn(problem.camera1.Ray(match.x1_px), whitened.camera1.Ray(other.x1_px)),
          FindTurn(problem.camera2.Ray(match.x2_px), whitened.camera2.Ray(other.x2_px))};
}
RelativePose Turn(const RelativePose& pose, const Turns& turns) {
  return {turns.of_camera2 * pose.R * turns.of_camera1.transpose(), turns.of_camera2 * pose.t};
}

TEST(WhitenedProblem, TurnsTheRays) {
  for (std::uint32_t trial = 0; trial < 30; ++trial) {
    const Case c = MakeCase(trial);
    const WhitenedProblem whitened(c.random.problem, c.shape);
    const MotionProblem& turned = whitened.problem();
    const Turns turns = FindTurns(c.random.problem, turned);
    for (size_t i = 0; i < turned.matches.size(); ++i) {
      const Correspondence &match = c.random.problem.matches[i], &now = turned.matches[i];
      EXPECT_TRUE(turned.camera1.Ray(now.x1_px).isApprox(
          turns.of_camera1 * c.random.problem.camera1.Ray(match.x1_px), 1e-12));
      EXPECT_TRUE(turned.camera2.Ray(now.x2_px).isApprox(
          turns.of_camera2 * c.random.problem.camera2.Ray(match.x2_px), 1e-12));
    }
    const double stretched =
        turned.camera1.fx * turned.camera1.fy / (c.random.problem.camera1.fx * c.random.problem.camera1.fy);
    EXPECT_NEAR(stretched, 1.0 / std::sqrt(c.shape.determinant()), 1e-9 * stretched)
        << "sigma_px is the root mean square over the axes";
    EXPECT_NEAR(turned.camera1.width * turned.camera1.height, stretched * 640 * 480,
                1e-2 * stretched * 640 * 480);
    const double between = AngleBetween(turns.of_camera1.col(0), turns.of_camera2.col(0));
    EXPECT_LT(between, 15.0 * kRadPerDeg) << "the cameras are not turned against each other";
  }
}

// The Sampson residual of the whitened problem is g over its standard deviation under the shape.
TEST(WhitenedProblem, ItsResidualsHaveTheStandardDeviationOfTheShape) {
  for (std::uint32_t trial = 0; trial < 30; ++trial) {
    const Case c = MakeCase(trial);
    const WhitenedProblem whitened(c.random.problem, c.shape);
    const MotionProblem& turned = whitened.problem();
    const RelativePose& pose = c.random.pose_true;
    const Turns turns = FindTurns(c.random.problem, turned);
    const Eigen::Matrix3d F =
        FundamentalFromEssential(EssentialFromPose(pose), c.random.problem.camera1, c.random.problem.camera2);
    const Eigen::Matrix3d F_now =
        FundamentalFromEssential(EssentialFromPose(Turn(pose, turns)), turned.camera1, turned.camera2);
    for (size_t i = 0; i < turned.matches.size(); ++i) {
      const EpipolarConstraint constraint = EvaluateConstraint(F, c.random.problem.matches[i]);
      const Eigen::Vector2d j1 = constraint.gradient.head<2>(), j2 = constraint.gradient.tail<2>();
      const double variance = j1.dot(c.shape * j1) + j2.dot(c.shape * j2);
      const double expected = constraint.g * constraint.g / variance;
      EXPECT_NEAR(SquaredSampsonDistance(F_now, turned.matches[i]), expected, 1e-9 * (1.0 + expected));
    }
  }
}

// The covariance of the restored motion is that of restored motions: to first order the tangent of one
// restored is the restored one's.
TEST(WhitenedProblem, RestoresMotionsAndCovariances) {
  for (std::uint32_t trial = 0; trial < 30; ++trial) {
    const Case c = MakeCase(trial);
    const WhitenedProblem whitened(c.random.problem, c.shape);
    const Turns turns = FindTurns(c.random.problem, whitened.problem());
    MotionEstimate estimate;
    estimate.cam2_from_cam1 = estimate.initial_pose = Turn(c.random.pose_true, turns);
    Vector5d step;
    step << 0.1, -0.2, 0.3, -0.4, 0.5;
    step *= 1e-5;
    estimate.pose_cov = step * step.transpose();
    estimate.sigma_estimated_px = 1.0;
    MotionEstimate moved = estimate;
    moved.cam2_from_cam1 = Retract(estimate.cam2_from_cam1, step);
    estimate.other_modes = {{estimate.cam2_from_cam1, estimate.pose_cov, 0.1, 0.0}};
    whitened.Restore(&estimate);
    whitened.Restore(&moved);
    EXPECT_TRUE(estimate.cam2_from_cam1.R.isApprox(c.random.pose_true.R, 1e-12));
    EXPECT_TRUE(estimate.initial_pose.t.isApprox(c.random.pose_true.t, 1e-12));
    EXPECT_TRUE(estimate.other_modes[0].cam2_from_cam1.t.isApprox(c.random.pose_true.t, 1e-12));
    const Vector5d away = LocalCoordinates(estimate.cam2_from_cam1, moved.cam2_from_cam1);
    const Matrix5d expected = away * away.transpose();
    EXPECT_LT((estimate.pose_cov - expected).norm(), 1e-4 * expected.norm()) << trial;
    EXPECT_LT((estimate.other_modes[0].pose_cov - expected).norm(), 1e-4 * expected.norm()) << trial;
    EXPECT_EQ(estimate.sigma_estimated_px, 1.0);
  }
}

// Distances do not depend on the frames: every probability about any motion stays, that of an uneven ring of
// cells, too.
TEST(WhitenedProblem, RestoresAPosterior) {
  const MotionBounds bounds{3.0 * kRadPerDeg, 15.0 * kRadPerDeg};
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const Case c = MakeCase(trial);
    const WhitenedProblem whitened(c.random.problem, c.shape);
    const Turns turns = FindTurns(c.random.problem, whitened.problem());
    const RelativePose answer = Turn(c.random.pose_true, turns);
    Matrix5d covariance = 1e-3 * Matrix5d::Identity();
    covariance(0, 3) = covariance(3, 0) = 5e-4;
    Vector5d step;
    step << 0.01, -0.02, 0.03, 0.4, -0.5;
    DirectionCell cell{0.1, 0.2, 0.5, 0.9, 0.6, {0.01, 0.02, -0.01}, 1e-4 * Eigen::Matrix3d::Identity()};
    cell.rotation_cov(0, 0) = 4e-4;
    MotionPosterior posterior =
        MakeMotionPosterior(answer, bounds, 0.3, {{Retract(answer, step), covariance, 0.2, false}}, {cell});
    const RelativePose about = Retract(answer, 0.5 * step);
    const double before = FailureProbability(posterior, about, {0.03, 0.3});
    whitened.Restore(&posterior);
    MotionEstimate restored;
    restored.cam2_from_cam1 = about;
    whitened.Restore(&restored);
    EXPECT_TRUE(posterior.answer.t.isApprox(c.random.pose_true.t, 1e-12));
    EXPECT_NEAR(FailureProbability(posterior, restored.cam2_from_cam1, {0.03, 0.3}), before, 0.01) << trial;
  }
}

TEST(WhitenedProblem, TurnsThePrior) {
  const Case c = MakeCase(3);
  MotionProblem problem = c.random.problem;
  const RelativePose& pose = c.random.pose_true;
  Eigen::Matrix3d rotation_cov = Eigen::Vector3d(1e-4, 2e-4, 4e-4).asDiagonal();
  const Eigen::Vector3d down = Eigen::Vector3d(0.1, 0.9, 0.2).normalized();
  problem.prior =
      MotionPrior{RotationPrior{RotationFromVector({0.01, 0.02, 0.03}) * pose.R, rotation_cov},
                  GravityPrior{down, RotationFromVector({0.02, 0.0, 0.01}) * pose.R * down, 0.01, 0.02},
                  DirectionPrior{(pose.t + Eigen::Vector3d(0.1, 0.0, 0.1)).normalized(), 0.1}};
  const WhitenedProblem whitened(problem, c.shape);
  const RelativePose turned = Turn(pose, FindTurns(c.random.problem, whitened.problem()));
  EXPECT_NEAR(EvaluatePrior(*whitened.problem().prior, turned).cost, EvaluatePrior(*problem.prior, pose).cost,
              1e-9);
  EXPECT_GT(EvaluatePrior(*problem.prior, pose).cost, 1.0);
}

}  // namespace
}  // namespace rcme
