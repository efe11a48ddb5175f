// The posterior against closed forms, and against draws from it on problems of every kind.
#include "estimator/calibrated/motion_posterior.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "estimator/estimators/rcme_calibrated.h"
#include "stats/constants.h"
#include "stats/distributions.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

constexpr MotionBounds kUsual{3.0 * kRadPerDeg, 15.0 * kRadPerDeg};
const RelativePose kStands{RotationFromVector({0.2, -0.1, 0.3}),
                           Eigen::Vector3d(2.0, -1.0, 0.5).normalized()};

MotionComponent ComponentAt(const RelativePose& mean, double rotation_sd, double direction_sd, double weight,
                            bool is_answer) {
  MotionComponent component{mean, Matrix5d::Zero(), weight, is_answer};
  component.covariance.diagonal() << Eigen::Vector3d::Constant(rotation_sd * rotation_sd),
      Eigen::Vector2d::Constant(direction_sd * direction_sd);
  return component;
}
MotionPosterior MakePosterior(double p, std::vector<MotionComponent> components) {
  return MakeMotionPosterior(kStands, kUsual, p, std::move(components), {});
}
RelativePose Turned(double direction_deg) {
  Vector5d tangent = Vector5d::Zero();
  tangent(3) = direction_deg * kRadPerDeg;
  return Retract(kStands, tangent);
}

TEST(MakeMotionPosterior, WhatIsNeitherAnswerNorRivalIsNone) {
  const MotionPosterior posterior = MakePosterior(
      0.3, {ComponentAt(kStands, 1e-3, 1e-3, 0.5, true), ComponentAt(Turned(60.0), 1e-3, 1e-3, 0.1, false)});
  EXPECT_NEAR(posterior.components[0].weight, 0.7, 1e-12);
  EXPECT_NEAR(posterior.components[1].weight, 0.1, 1e-12);
  EXPECT_NEAR(posterior.weight_of_none, 0.2, 1e-12);
  EXPECT_EQ(posterior.narrowed, 1.0);
}

TEST(MakeMotionPosterior, StatesWhatItIsTold) {
  for (const double p : {0.0, 1e-4, 0.02, 0.3, 0.9, 1.0}) {
    for (const double sd : {1e-3, 0.02, 0.2, 1.0}) {
      for (const double rival : {0.0, 0.2, 0.6}) {
        const MotionPosterior posterior =
            MakePosterior(p, {ComponentAt(kStands, 0.1 * sd, sd, 1.0 - rival, true),
                              ComponentAt(Turned(25.0), 0.01, 0.1, rival, false)});
        EXPECT_NEAR(FailureProbability(posterior, kStands, kUsual), p, 1e-9) << sd << " " << rival;
      }
    }
  }
}

// The answer alone would leave exp(-.5 (15 / 30)^2) = .88 beyond 15 deg.
TEST(MakeMotionPosterior, NarrowsAnAnswerThatIsWiderThanItsProbability) {
  const double sd = 30.0 * kRadPerDeg;
  const MotionPosterior posterior = MakePosterior(0.1, {ComponentAt(kStands, 1e-3, sd, 1.0, true)});
  EXPECT_NEAR(posterior.narrowed, 0.5 / std::sqrt(-2.0 * std::log(0.1)), 0.02);
  EXPECT_NEAR(posterior.components[0].covariance(4, 4), std::pow(posterior.narrowed * sd, 2), 1e-12);
  EXPECT_LT(posterior.weight_of_none, 0.02);
}

// The points' error is stated as some thousandths.
TEST(PosteriorDistances, OfARoundDirectionAreRayleighs) {
  const double sd = 10.0 * kRadPerDeg;
  const MotionPosterior posterior{kStands, {ComponentAt(kStands, 1e-6, sd, 1.0, true)}, {}, 0.0, 1.0};
  const PosteriorDistances distances(posterior, kStands);
  for (const double angle_deg : {2.0, 5.0, 10.0, 20.0, 30.0}) {
    const double beyond = std::exp(-0.5 * std::pow(angle_deg / 10.0, 2));
    EXPECT_NEAR(distances.FailureProbability({1.0, angle_deg * kRadPerDeg}), beyond, 0.02) << angle_deg;
  }
  EXPECT_NEAR(distances.FindQuantile(0.5).direction_rad, sd * std::sqrt(2.0 * std::log(2.0)), 0.05 * sd);
}

TEST(PosteriorDistances, NoRegionHoldsWhatNoneTakesAway) {
  const MotionPosterior posterior = MakePosterior(0.3, {ComponentAt(kStands, 1e-3, 1e-2, 1.0, true)});
  const PosteriorDistances distances(posterior, kStands);
  EXPECT_TRUE(std::isfinite(distances.RegionAt(0.69, kUsual).rotation_rad));
  EXPECT_TRUE(std::isinf(distances.RegionAt(0.71, kUsual).rotation_rad));
  EXPECT_TRUE(std::isinf(distances.FindQuantile(0.71).direction_rad));
}

// Of two motions the median is the likelier one.
// A mode with a tenth of a radian of spread and a cell far narrower, half of the weight each: the variance is
// half of the mode's.
TEST(Covariance, OfModesAndCellsIsThatOfTheMixture) {
  MotionPosterior posterior;
  posterior.answer = {Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ()};
  const Matrix5d wide = 0.01 * Matrix5d::Identity();
  posterior.components = {{posterior.answer, wide, 0.5, true}};
  posterior.cells = {{0.0, 1e-6, 0.0, 1.0, 0.5}};
  posterior.weight_of_none = 0.0;
  EXPECT_LT((Covariance(posterior).of_answer - 0.5 * wide).norm(), 1e-4);
}

TEST(Median, IsTheLikelierOfTwo) {
  const MotionPosterior posterior{
      kStands,
      {ComponentAt(kStands, 1e-3, 1e-3, 0.4, true), ComponentAt(Turned(60.0), 1e-3, 1e-3, 0.6, false)},
      {},
      0.0,
      1.0};
  EXPECT_LT(AngleBetween(Median(posterior).t, Turned(60.0).t), 2.0 * kRadPerDeg);
}

// A sphere of cells, all alike: of a uniform direction.
TEST(Draw, FromCellsIsUniformInEach) {
  MotionPosterior posterior{kStands, {}, {}, 0.0, 1.0};
  posterior.cells = {{0.0, 1.0, 0.0, 2.0 * std::numbers::pi, (1.0 - std::cos(1.0)) / 2.0},
                     {1.0, std::numbers::pi, 0.0, 2.0 * std::numbers::pi, (1.0 + std::cos(1.0)) / 2.0}};
  RandomStream rng({.seed = 1, .purpose = 2920});
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  constexpr int kNumber = 20000;
  for (int k = 0; k < kNumber; ++k) {
    const std::optional<RelativePose> pose = Draw(posterior, rng);
    ASSERT_TRUE(pose.has_value());
    sum += pose->t / kNumber;
    squares += pose->t * pose->t.transpose() / kNumber;
  }
  // Four standard errors: of a component sqrt(1 / 3 / n), of its square sqrt(4 / 45 / n).
  EXPECT_LT(sum.cwiseAbs().maxCoeff(), 4.0 * std::sqrt(1.0 / 3.0 / kNumber));
  EXPECT_LT((squares - Eigen::Matrix3d::Identity() / 3.0).cwiseAbs().maxCoeff(),
            4.0 * std::sqrt(4.0 / 45.0 / kNumber));
}

// Below, real posteriors. Deep, a plane, hardly any parallax, few matches, and the ten of docs/estimate.md.
enum class Kind { kDeep, kPlane, kLowParallax, kFew, kTen };
constexpr Kind kKinds[] = {Kind::kDeep, Kind::kPlane, Kind::kLowParallax, Kind::kFew, Kind::kTen};

MotionProblem TenMatches() {
  constexpr double kRows[][4] = {{317.4, 192.2, 399.0, 253.5}, {204.1, 158.6, 248.8, 191.9},
                                 {160.5, 258.4, 212.9, 297.8}, {403.3, 247.8, 509.9, 327.3},
                                 {451.8, 278.4, 500.9, 315.1}, {451.7, 124.5, 493.7, 155.6},
                                 {220.2, 227.0, 273.3, 266.5}, {373.4, 331.5, 415.4, 364.1},
                                 {485.4, 326.0, 530.1, 359.8}, {214.5, 115.1, 270.3, 158.1}};
  const Camera camera{600.0, 600.0, 319.5, 239.5, 640, 480};
  MotionProblem problem{{}, camera, camera, 0.5, {}};
  for (const auto& row : kRows) problem.matches.push_back({{row[0], row[1]}, {row[2], row[3]}});
  return problem;
}

MotionProblem MakeKindProblem(Kind kind, std::uint32_t trial) {
  if (kind == Kind::kTen) return TenMatches();
  Scene scene = TwoCameraScene(kind == Kind::kFew ? 14 : 120, 300 + trial);
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.1, 1.0).normalized();
  for (Eigen::Vector3d& point : scene.points_in_cam1) {
    if (kind == Kind::kPlane) point *= 4.0 / normal.dot(point);
    if (kind == Kind::kLowParallax) point *= 60.0;
  }
  return {ObserveTwoCameraScene(scene, 0.5, kind == Kind::kFew ? 0.0 : 0.2, 300 + trial).matches,
          scene.camera1, scene.camera2, 0.5};
}

struct Posed {
  MotionEstimate estimate;
  MotionPosterior posterior;
};
// With errors of the calibration, so that each mode within the bounds has two components.
CalibratedOptions WithUnstatedErrors() {
  CalibratedOptions options;
  options.unstated_errors = 0.01;
  return options;
}
std::vector<Posed> ComputePosteriors(Kind kind, const CalibratedOptions& options = WithUnstatedErrors()) {
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated(options);
  std::vector<Posed> all;
  for (std::uint32_t trial = 0; trial < (kind == Kind::kTen ? 1u : 4u); ++trial) {
    RandomStream rng({1, 0, trial, 4});
    std::optional<MotionPosterior> posterior;
    const MotionEstimate estimate =
        FindWeightInspection(*estimator)
            ->EstimateWithPosterior(MakeKindProblem(kind, trial), rng, &posterior);
    if (estimate.status == MotionStatus::kOk) all.push_back({estimate, *posterior});
  }
  EXPECT_FALSE(all.empty());
  return all;
}

constexpr MotionBounds kManyBounds[] = {
    {0.2 * kRadPerDeg, 1.0 * kRadPerDeg},  {1.0 * kRadPerDeg, 5.0 * kRadPerDeg},
    {2.0 * kRadPerDeg, 10.0 * kRadPerDeg}, kUsual,
    {5.0 * kRadPerDeg, 20.0 * kRadPerDeg}, {10.0 * kRadPerDeg, 40.0 * kRadPerDeg},
    {std::numbers::pi, 90.0 * kRadPerDeg}};

TEST(PosteriorOfPairs, StatesTheReportedProbability) {
  for (const Kind kind : kKinds) {
    for (const Posed& of : ComputePosteriors(kind))
      EXPECT_NEAR(FailureProbability(of.posterior, of.estimate.cam2_from_cam1, kUsual),
                  of.estimate.failure_probability, 1e-9);
  }
}

TEST(PosteriorOfPairs, FallsWithTheBoundsFromOne) {
  for (const Kind kind : kKinds) {
    for (const Posed& of : ComputePosteriors(kind)) {
      const PosteriorDistances distances(of.posterior, of.estimate.cam2_from_cam1);
      double last = distances.FailureProbability({0.0, 0.0});
      EXPECT_NEAR(last, 1.0, 1e-9);
      for (const MotionBounds& bounds : kManyBounds) {
        const double p = distances.FailureProbability(bounds);
        EXPECT_LE(p, last);
        last = p;
      }
      EXPECT_NEAR(distances.FailureProbability({std::numbers::pi, std::numbers::pi}),
                  of.posterior.weight_of_none, 1e-9);
    }
  }
}

// Four standard errors of 20,000 draws (a false alarm in 16,000 for each of 119 numbers), and the points' own
// error, .01.
TEST(PosteriorOfPairs, DrawsGiveEveryProbabilityAndRegion) {
  constexpr int kNumber = 20000;
  for (const Kind kind : kKinds) {
    for (const Posed& of : ComputePosteriors(kind)) {
      const RelativePose& answer = of.estimate.cam2_from_cam1;
      const PosteriorDistances distances(of.posterior, answer);
      RandomStream rng({.seed = 1, .purpose = 2921});
      std::vector<std::optional<RelativePose>> draws;
      for (int k = 0; k < kNumber; ++k) draws.push_back(Draw(of.posterior, rng));
      const auto expect_beyond = [&](const MotionBounds& bounds, double p) {
        const auto is_beyond = [&](const auto& pose) { return !pose || !IsWithin(answer, bounds, *pose); };
        const double share = static_cast<double>(std::ranges::count_if(draws, is_beyond)) / kNumber;
        EXPECT_NEAR(share, p, 4.0 * std::sqrt(p * (1.0 - p) / kNumber) + 0.01)
            << static_cast<int>(kind) << ": " << bounds.direction_rad * kDegPerRad;
      };
      for (const MotionBounds& bounds : kManyBounds)
        expect_beyond(bounds, distances.FailureProbability(bounds));
      for (const double level : {0.5, 0.9}) {
        if (level < 1.0 - of.posterior.weight_of_none - 0.02)
          expect_beyond(distances.RegionAt(level, kUsual), 1.0 - level);
      }
    }
  }
}

// The answer's part alone: its second moment is the one that is computed, which is the stated covariance
// where nothing was narrowed and the direction is normal. An element of the whitened matrix has at most the
// variance 3 sum w m^2 / 20000 over the components, w their weights and m their greatest whitened variance
// (1 if there are only cells), of which five standard errors are allowed; .05 more for modes beside the
// answer, whose tangents are not its own, and motions beyond half a turn, which come back from the other
// side.
TEST(PosteriorOfPairs, DrawsOfTheAnswerHaveItsCovariance) {
  constexpr int kNumber = 20000;
  int num_stated = 0;
  for (const Kind kind : kKinds) {
    for (Posed& of : ComputePosteriors(kind)) {
      const Matrix5d covariance = Covariance(of.posterior).of_answer;
      if (of.posterior.narrowed == 1.0 && of.posterior.cells.empty()) {
        EXPECT_LT((covariance - of.estimate.pose_cov).norm(), 1e-9 * of.estimate.pose_cov.norm());
        ++num_stated;
      }
      if (covariance.diagonal().tail<2>().maxCoeff() > 0.2) continue;  // wraps around
      std::erase_if(of.posterior.components, [](const MotionComponent& c) { return !c.is_answer; });
      of.posterior.weight_of_none = 0.0;
      double total = 0.0;
      for (const MotionComponent& c : of.posterior.components) total += c.weight;
      for (const DirectionCell& c : of.posterior.cells) total += c.weight;
      ASSERT_GT(total, 0.0);
      for (MotionComponent& c : of.posterior.components) c.weight /= total;
      for (DirectionCell& c : of.posterior.cells) c.weight /= total;
      RandomStream rng({.seed = 1, .purpose = 2922});
      Matrix5d sum = Matrix5d::Zero();
      for (int k = 0; k < kNumber; ++k) {
        const std::optional<RelativePose> pose = Draw(of.posterior, rng);
        if (!pose) continue;  // a rounding of the weights
        const Vector5d away = LocalCoordinates(of.estimate.cam2_from_cam1, *pose);
        sum += away * away.transpose() / kNumber;
      }
      const Eigen::LLT<Matrix5d> llt(covariance);
      const auto whiten = [&](const Matrix5d& moment) -> Matrix5d {
        const Matrix5d half = llt.matrixL().solve(moment);
        return llt.matrixL().solve(half.transpose());
      };
      double fourth = of.posterior.components.empty() ? 3.0 : 0.0;
      for (const MotionComponent& c : of.posterior.components)
        fourth += 3.0 * c.weight * std::pow(whiten(c.covariance).eigenvalues().real().maxCoeff(), 2);
      const double allowed = 5.0 * std::sqrt(fourth / kNumber) + 0.05;
      const Matrix5d whitened = whiten(sum);
      EXPECT_LT((whitened - Matrix5d::Identity()).cwiseAbs().maxCoeff(), allowed) << static_cast<int>(kind);
    }
  }
  EXPECT_GE(num_stated, 5);
}

// No motion of these has a smaller mean angle to the draws.
TEST(PosteriorOfPairs, TheMedianIsNearestToDraws) {
  for (const Kind kind : kKinds) {
    for (const Posed& of : ComputePosteriors(kind)) {
      const RelativePose median = Median(of.posterior);
      RandomStream rng({.seed = 1, .purpose = 2923});
      double of_median = 0.0, of_answer = 0.0;
      for (int k = 0; k < 5000; ++k) {
        const std::optional<RelativePose> pose = Draw(of.posterior, rng);
        if (!pose) continue;
        of_median += AngleBetween(median.t, pose->t);
        of_answer += AngleBetween(of.estimate.cam2_from_cam1.t, pose->t);
      }
      EXPECT_LE(of_median, 1.02 * of_answer) << static_cast<int>(kind);
    }
  }
}

TEST(PosteriorOfPairs, AskingForItChangesNothing) {
  const std::unique_ptr<MotionEstimator> estimator = MakeRcmeCalibrated({});
  for (const Kind kind : kKinds) {
    const MotionProblem problem = MakeKindProblem(kind, 1);
    RandomStream rng({1, 0, 1, 4}), other({1, 0, 1, 4});
    std::optional<MotionPosterior> posterior;
    const MotionEstimate asked = FindWeightInspection(*estimator)
                                     ->EstimateWithPosterior(problem, rng, &posterior),
                         plain = estimator->Estimate(problem, other);
    EXPECT_EQ(asked.failure_probability, plain.failure_probability);
    EXPECT_EQ(asked.pose_cov, plain.pose_cov);
    EXPECT_EQ(asked.cam2_from_cam1.R, plain.cam2_from_cam1.R);
    EXPECT_EQ(rng.Next64(), other.Next64());
  }
}

// Of every kind of covariance and without the check.
TEST(PosteriorOfPairs, HoldsForOtherOptions) {
  for (const CovarianceKind covariance : {CovarianceKind::kInformation, CovarianceKind::kRobust}) {
    for (const CalibratedStep step : {CalibratedStep::kNone, CalibratedStep::kModelCheck}) {
      CalibratedOptions options;
      options.covariance = covariance;
      options.leave_out = step;
      for (const Posed& of : ComputePosteriors(Kind::kDeep, options)) {
        EXPECT_NEAR(FailureProbability(of.posterior, of.estimate.cam2_from_cam1, kUsual),
                    of.estimate.failure_probability, 1e-9);
        if (of.posterior.narrowed == 1.0) {
          EXPECT_LT((Covariance(of.posterior).of_answer - of.estimate.pose_cov).norm(),
                    1e-9 * of.estimate.pose_cov.norm());
        }
      }
    }
  }
}

}  // namespace
}  // namespace rcme
