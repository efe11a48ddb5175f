// The covariance of a mode against the errors of fits, and against fits with other intrinsics.
#include "estimator/calibrated/mode_covariance.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "estimator/calibrated/influence.h"
#include "stats/distributions.h"
#include "tests/test_support/calibrated_mode.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

Matrix5d ComputeSandwich(const FittedMode& f) {
  return SandwichCovariance(f.mode, Explain(f.matches, f.mode), InverseOfObserved(f.matches, f.mode));
}
Matrix5d ComputeIntrinsics(const FittedMode& f, const CalibrationPrior& calibration) {
  return IntrinsicsCovariance(f.problem, calibration, f.mode, InverseOfObserved(f.matches, f.mode));
}

// 400 scenes without wrong matches. The sandwich is a little wide for few matches (the greater of two
// middles), so that a range is nominal: .94 to .99. Its exact interval of confidence 0.9999
// must meet it: a false alarm in 10,000 at most. A covariance half as great covers .81, which it finds with
// certainty.
TEST(SandwichCovariance, CoversTheTruthAsOftenAsItSays) {
  const double bound = ChiSquareQuantile(5, 0.95);
  for (const int n : {60, 200}) {
    CoverageCount count;
    for (std::uint32_t trial = 0; trial < 400; ++trial) {
      const FittedMode f = FitScene(n, 0.5, 0.0, trial);
      ASSERT_TRUE(f.has_converged) << trial;
      const Matrix5d covariance = ComputeSandwich(f);
      const Vector5d error = LocalCoordinates(f.mode.pose, f.pose_true);
      count.Add(error.dot(covariance.llt().solve(error)) <= bound);
    }
    EXPECT_LT(count.interval().lower, 0.99) << n << ": " << count;
    EXPECT_GT(count.interval().upper, 0.94) << n << ": " << count;
  }
}

// Its scale is estimated, so that the unit of the assumed sigma means nothing beside the prior's weight.
TEST(SandwichCovariance, DoesNotDependOnTheAssumedSigma) {
  const FittedMode right = FitScene(400, 0.5, 0.2, 7), wrong = FitScene(400, 0.5, 0.2, 7, 2.0);
  const Matrix5d a = ComputeSandwich(right);
  const Matrix5d b = ComputeSandwich(wrong);
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(b(k, k) / a(k, k), 1.0, 0.25);
}

// Forward motion; the optimum's direction is moved, by less than its standard deviation, to where the two
// coordinates across the axis are equal: there DirectionBasis turns by 90 deg.
FittedMode FitWhereTheBasisTurns(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2813});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 200});
  const RelativePose pose{RotationFromVector({0.02, -0.01, 0.03}),
                          Eigen::Vector3d(0.1, 0.1, 1.0).normalized()};
  for (size_t i = 0; i < random.points_in_cam1.size(); ++i) {
    random.problem.matches[i] =
        ProjectToBoth(random.points_in_cam1[i], pose, random.problem.camera1, random.problem.camera2);
  }
  AddNoise(0.3, rng, &random.problem);
  FittedMode f = FitFromTruth(random.problem, pose);
  Eigen::Vector3d& t = f.mode.pose.t;
  t.x() = t.y() = 0.5 * (t.x() + t.y());
  t.normalize();
  f.mode.inverse_hessian =
      SumPosterior(f.matches, f.mode.used, f.prior, f.mode.pose, f.mode.mixture).hessian.inverse();
  return f;
}

// Second differences of the likelihood itself, over steps of a tenth of a standard deviation.
Matrix5d InverseOfSecondDifferences(const FittedMode& f) {
  const Matrix5d root = f.mode.inverse_hessian.llt().matrixL();
  constexpr double kStep = 0.1;
  const auto cost_at = [&](int i, double a, int j, double b) {
    const Vector5d step = kStep * (a * root.col(i) + b * root.col(j));
    return -SumLogPosterior(f.matches, f.mode.used, f.prior, Retract(f.mode.pose, step), f.mode.mixture);
  };
  Matrix5d hessian;
  for (int i = 0; i < 5; ++i) {
    for (int j = 0; j < 5; ++j) {
      hessian(i, j) =
          (cost_at(i, 1, j, 1) - cost_at(i, 1, j, -1) - cost_at(i, -1, j, 1) + cost_at(i, -1, j, -1)) /
          (4.0 * kStep * kStep);
    }
  }
  return root * hessian.inverse() * root.transpose();
}

TEST(InverseOfObserved, IsThatOfTheLikelihoodWhereTheBasisTurns) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    const FittedMode f = FitWhereTheBasisTurns(trial);
    ASSERT_TRUE(f.has_converged);
    const Matrix5d expected = InverseOfSecondDifferences(f);
    EXPECT_LT((InverseOfObserved(f.matches, f.mode) - expected).norm(), 0.02 * expected.norm()) << trial;
  }
}

// 200 matches of points twenty times as far as the first eight, on which the direction rests alone.
FittedMode FitFewNear(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 2812});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 208});
  for (size_t i = 8; i < random.points_in_cam1.size(); ++i) {
    random.problem.matches[i] = ProjectToBoth(20.0 * random.points_in_cam1[i], random.pose_true,
                                              random.problem.camera1, random.problem.camera2);
  }
  AddNoise(0.5, rng, &random.problem);
  return FitFromTruth(random.problem, random.pose_true);
}

// The axes of the greatest and the least variance.
TEST(EffectiveMatches, AreThoseThatAnAxisRestsOn) {
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    for (const bool is_few : {true, false}) {
      const FittedMode f = is_few ? FitFewNear(trial) : FitScene(208, 0.5, 0.0, trial);
      ASSERT_TRUE(f.has_converged);
      const Matrix5d inverse = InverseOfObserved(f.matches, f.mode);
      const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(ComputeSandwich(f));
      const Vector5d effective =
          EffectiveMatches(f.mode, Explain(f.matches, f.mode), inverse * eigen.eigenvectors());
      EXPECT_GT(effective(4), is_few ? 1.0 : 15.0);
      EXPECT_LT(effective(4), is_few ? 12.0 : 208.0);
      EXPECT_GT(effective(0), 30.0);
    }
  }
}

// To where steps are nothing beside the moves that are looked for; the mixture stays.
RelativePose Optimum(const FittedMode& f, const MotionProblem& problem) {
  const MatchBlocks matches(problem);
  Mode mode = f.mode;
  for (int step = 0; step < 30; ++step) FitMode(matches, f.prior, 1, &mode, MixtureUpdate::kNone);
  return mode.pose;
}
Vector5d MovedBy(const FittedMode& f, const MotionProblem& changed) {
  return LocalCoordinates(Optimum(f, f.problem), Optimum(f, changed));
}

// One standard deviation of each, and the motion fitted again.
TEST(IntrinsicsCovariance, IsThatOfFitsWithOtherIntrinsics) {
  const FittedMode f = FitScene(300, 0.5, 0.0, 5);
  constexpr double kFocal = 2e-4, kShiftPx = 0.05;
  Matrix5d of_focal = Matrix5d::Zero(), of_points = Matrix5d::Zero();
  for (Camera MotionProblem::*camera : {&MotionProblem::camera1, &MotionProblem::camera2}) {
    MotionProblem changed = f.problem;
    (changed.*camera).fx *= 1.0 + kFocal;
    (changed.*camera).fy *= 1.0 + kFocal;
    const Vector5d moved = MovedBy(f, changed);
    of_focal += moved * moved.transpose();
    for (double Camera::*coordinate : {&Camera::cx, &Camera::cy}) {
      MotionProblem shifted = f.problem;
      shifted.*camera.*coordinate += kShiftPx;
      const Vector5d by_shift = MovedBy(f, shifted);
      of_points += by_shift * by_shift.transpose();
    }
  }
  CalibrationPrior calibration;
  calibration.focal_sd = kFocal;
  const Matrix5d focal = ComputeIntrinsics(f, calibration);
  EXPECT_LT((focal - of_focal).norm(), 0.2 * of_focal.norm()) << focal << "\n\n" << of_focal;
  calibration = {};
  calibration.principal_point_sd_px = kShiftPx;
  const Matrix5d points = ComputeIntrinsics(f, calibration);
  EXPECT_LT((points - of_points).norm(), 0.2 * of_points.norm()) << points << "\n\n" << of_points;
  calibration.focal_sd = kFocal;
  EXPECT_LT((ComputeIntrinsics(f, calibration) - focal - points).norm(), 1e-9 * points.norm());
  EXPECT_EQ(ComputeIntrinsics(f, {}).norm(), 0.0);
}

// The principal points are uncertain in other pixels than the problem's, as after a turn of the cameras.
TEST(IntrinsicsCovariance, OfPrincipalPointsInOtherPixels) {
  const FittedMode f = FitScene(300, 0.5, 0.0, 2);
  constexpr double kShiftPx = 0.02;
  Eigen::Matrix2d of_pixels;
  of_pixels << 2.0, 0.3, -0.1, 0.5;
  Matrix5d expected = Matrix5d::Zero();
  for (Camera MotionProblem::*camera : {&MotionProblem::camera1, &MotionProblem::camera2}) {
    for (const int axis : {0, 1}) {
      MotionProblem shifted = f.problem;
      (shifted.*camera).cx += kShiftPx * of_pixels(0, axis);
      (shifted.*camera).cy += kShiftPx * of_pixels(1, axis);
      const Vector5d moved = MovedBy(f, shifted);
      expected += moved * moved.transpose();
    }
  }
  CalibrationPrior calibration;
  calibration.principal_point_sd_px = kShiftPx;
  calibration.of_pixels1 = calibration.of_pixels2 = of_pixels;
  const Matrix5d found = ComputeIntrinsics(f, calibration);
  EXPECT_LT((found - expected).norm(), 0.2 * expected.norm()) << found << "\n\n" << expected;
}

// One camera took both images: its error is common to them.
TEST(IntrinsicsCovariance, OfOneCameraIsOfACommonError) {
  RandomStream rng({.seed = 1, .purpose = 2770});
  RandomProblem random = MakeRandomProblem(rng, {.num_matches = 300});
  random.problem.camera2 = random.problem.camera1;
  for (size_t i = 0; i < random.points_in_cam1.size(); ++i) {
    random.problem.matches[i] = ProjectToBoth(random.points_in_cam1[i], random.pose_true,
                                              random.problem.camera1, random.problem.camera2);
  }
  AddNoise(0.5, rng, &random.problem);
  const FittedMode f = FitFromTruth(random.problem, random.pose_true);
  MotionProblem changed = f.problem;
  constexpr double kFocal = 2e-4;
  for (Camera* camera : {&changed.camera1, &changed.camera2}) {
    camera->fx *= 1.0 + kFocal;
    camera->fy *= 1.0 + kFocal;
  }
  const Vector5d moved = MovedBy(f, changed);
  CalibrationPrior calibration;
  calibration.focal_sd = kFocal;
  const Matrix5d expected = moved * moved.transpose();
  EXPECT_LT((ComputeIntrinsics(f, calibration) - expected).norm(), 0.2 * expected.norm());
}

// The formula of the header match by match, of 12 matches, where leverages are great and all axes rest on
// few.
TEST(SandwichCovariance, IsThatOfTheHeader) {
  for (std::uint32_t trial = 0; trial < 5; ++trial) {
    const FittedMode f = FitScene(12, 0.5, 0.0, trial);
    const Explanation e = Explain(f.matches, f.mode);
    const MixtureParameters& m = f.mode.mixture;
    const Matrix5d inverse = InverseOfObserved(f.matches, f.mode);
    const std::vector<double> wrong = WrongByInfluence(f.mode, e);
    Matrix5d S = Matrix5d::Zero(), geometry = S, doubt = S;
    double squares = 0.0, right = 0.0;
    for (size_t i = 0; i < 12; ++i) {
      Vector5d J;
      for (size_t k = 0; k < 5; ++k) J(static_cast<Eigen::Index>(k)) = e.terms.derivative[k][i];
      const double u = e.terms.residual[i] / m.scale, v = 6.0 / (5.0 + u * u), p = e.probability[i];
      const double psi = p * v * u / m.scale, h = e.leverage[i];
      S += psi * psi / std::max(1.0 - h, 0.05) * J * J.transpose();
      geometry += p * J * J.transpose();
      const double kept = std::max(1.0 - h, 0.01);
      doubt += 0.5 * wrong[i] * (psi * psi / (kept * kept) + p * v / (m.scale * m.scale) / kept) * J *
               J.transpose();
      squares += psi * psi;
      right += p;
    }
    const double freedom = std::max(right - 5.0, 1.0);
    // The greater of S and of equal residuals along every direction: in coordinates in which the latter is
    // one.
    const Matrix5d L = Matrix5d(squares / freedom * geometry).llt().matrixL();
    const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(Matrix5d(L.inverse() * S * L.inverse().transpose()));
    const Matrix5d root = L * eigen.eigenvectors();
    const Matrix5d middle = root * eigen.eigenvalues().cwiseMax(1.0).asDiagonal() * root.transpose() + doubt;
    const Matrix5d covariance = inverse * middle * inverse;
    const Matrix5d axes = Eigen::SelfAdjointEigenSolver<Matrix5d>(covariance).eigenvectors();
    const Vector5d effective = EffectiveMatches(f.mode, e, inverse * axes);
    Vector5d factor;
    for (int k = 0; k < 5; ++k) {
      const double n = std::max(effective(k) < 30.0 ? std::min(effective(k), freedom) : freedom, 3.0);
      factor(k) = std::sqrt(n / (n - 2.0));
    }
    const Matrix5d widen = axes * factor.asDiagonal() * axes.transpose();
    const Matrix5d expected = widen * covariance * widen;
    EXPECT_LT((SandwichCovariance(f.mode, e, inverse) - expected).norm(), 1e-6 * expected.norm()) << trial;
  }
}

// The uniform law of the header: random rotations and directions have that covariance, a law without bounds
// gets it, and what is determined stays as it is.
TEST(BoundByUniformMotion, AddsTheInformationOfAUniformLaw) {
  RandomStream rng({.seed = 1, .purpose = 2772});
  Matrix5d uniform = Matrix5d::Zero();
  constexpr int kDraws = 20000;
  for (int k = 0; k < kDraws; ++k) {
    Eigen::Vector4d q;
    for (int i = 0; i < 4; ++i) q(i) = rng.Normal();
    const RelativePose random{Eigen::Quaterniond(q.normalized()).toRotationMatrix(), RandomDirection(rng)};
    const Vector5d away = LocalCoordinates({}, random);
    uniform += away * away.transpose() / kDraws;
  }
  const Matrix5d unbounded = BoundByUniformMotion(1e12 * Matrix5d::Identity());
  EXPECT_LT((unbounded - uniform).norm(), 0.05 * uniform.norm()) << unbounded << "\n\n" << uniform;
  Matrix5d root;
  for (int i = 0; i < 25; ++i) root(i / 5, i % 5) = 0.3 * rng.Normal();
  const Matrix5d some = root * root.transpose();
  const Matrix5d expected = (some.inverse() + unbounded.inverse()).inverse();
  EXPECT_LT((BoundByUniformMotion(some) - expected).norm(), 1e-5 * expected.norm());
  EXPECT_LT((BoundByUniformMotion(1e-6 * some) - 1e-6 * some).norm(), 1e-5 * (1e-6 * some).norm());
}

}  // namespace
}  // namespace rcme
