#include "experiments/trial/stated_density.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

constexpr double kRotationSd = 0.002, kDirectionSd = 0.03;  // rad, per axis

MotionEstimate Answer() {
  MotionEstimate estimate;
  estimate.status = MotionStatus::kOk;
  estimate.cam2_from_cam1 = {Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.6, 0.0, 0.8)};
  Vector5d variances;
  variances << Eigen::Vector3d::Constant(kRotationSd * kRotationSd),
      Eigen::Vector2d::Constant(kDirectionSd * kDirectionSd);
  estimate.pose_cov = variances.asDiagonal();
  return estimate;
}

// The truth is `error` away from the answer, in its tangent.
Truth TruthAway(const Vector5d& error) {
  Truth truth;
  truth.cam2_from_cam1_true = Retract(Answer().cam2_from_cam1, error);
  return truth;
}

Severity Bounds(double rotation_deg, double direction_deg) {
  Severity severity;
  severity.crb_rotation_deg = rotation_deg;
  severity.crb_direction_deg = direction_deg;
  return severity;
}

double ComputeNeesOfError(const Vector5d& error) {
  return error.head<3>().squaredNorm() / (kRotationSd * kRotationSd) +
         error.tail<2>().squaredNorm() / (kDirectionSd * kDirectionSd);
}

const Vector5d kError = (Vector5d() << 0.001, -0.003, 0.002, 0.02, -0.01).finished();

TEST(StatedDensity, SharpnessIsStatedOverTheBounds) {
  const double rotation_deg = kDegPerRad * std::sqrt(3.0) * kRotationSd;
  const double direction_deg = kDegPerRad * std::numbers::sqrt2 * kDirectionSd;
  const StatedDensity density =
      DescribeStatedDensity(Answer(), TruthAway(kError), Bounds(0.5 * rotation_deg, 2.0 * direction_deg),
                            ComputeNeesOfError(kError));
  EXPECT_NEAR(density.rotation_sd_deg, rotation_deg, 1e-12);
  EXPECT_NEAR(density.direction_sd_deg, direction_deg, 1e-12);
  EXPECT_NEAR(density.sd_over_crb, 1.0, 1e-12) << "2 and 1/2";
  EXPECT_NEAR(density.log_det_cov, 6.0 * std::log(kRotationSd) + 4.0 * std::log(kDirectionSd), 1e-12);
  EXPECT_TRUE(std::isnan(DescribeStatedDensity(Answer(), {}, {}, kNaN).sd_over_crb)) << "no bounds";
}

TEST(StatedDensity, LogScoreIsTheProductOfOneDimensionalDensities) {
  double expected = 0.0;
  for (int i = 0; i < 5; ++i) {
    const double sd = i < 3 ? kRotationSd : kDirectionSd, z = kError(i) / sd;
    expected += 0.5 * z * z + std::log(sd * std::sqrt(2.0 * std::numbers::pi));
  }
  EXPECT_NEAR(DescribeStatedDensity(Answer(), TruthAway(kError), {}, ComputeNeesOfError(kError)).log_score,
              expected, 1e-9);
}

TEST(StatedDensity, EnergyScoreIsThatOfDraws) {
  // 200,000 pairs of draws, 4.5 standard errors: a false alarm in 7e-6.
  RandomStream rng({.seed = 5, .purpose = 91});
  const auto draw = [&] {
    Vector5d x;
    for (int i = 0; i < 5; ++i) x(i) = rng.Normal() * (i < 3 ? kRotationSd : kDirectionSd);
    return x;
  };
  constexpr int kNumPairs = 200'000;
  double sum = 0.0, squares = 0.0;
  for (int k = 0; k < kNumPairs; ++k) {
    const Vector5d x = draw();
    const double score = kDegPerRad * ((x - kError).norm() - 0.5 * (x - draw()).norm());
    sum += score, squares += score * score;
  }
  const double mean = sum / kNumPairs, sd = std::sqrt(squares / kNumPairs - mean * mean);
  EXPECT_NEAR(
      DescribeStatedDensity(Answer(), TruthAway(kError), {}, ComputeNeesOfError(kError)).energy_score_deg,
      mean, 4.5 * sd / std::sqrt(1.0 * kNumPairs));
}

// Of axes of one standard deviation the squared length over it is chi-square, of 3 and of 2 coordinates.
TEST(StatedDensity, LevelsAreQuantilesOfChiSquare) {
  const StatedDensity density = DescribeStatedDensity(Answer(), {}, {}, kNaN);
  EXPECT_NEAR(density.rotation_level_deg, kDegPerRad * kRotationSd * std::sqrt(ChiSquareQuantile(3, 0.99)),
              1e-6);
  EXPECT_NEAR(density.direction_level_deg, kDegPerRad * kDirectionSd * std::sqrt(-2.0 * std::log(0.01)),
              1e-6);
  MotionEstimate unsure = Answer();
  unsure.failure_probability = 0.02;
  EXPECT_NEAR(DescribeStatedDensity(unsure, {}, {}, kNaN).direction_level_deg, 180.0, 1e-9)
      << "above the risk";
}

TEST(StatedDensity, OfASingularCovarianceHasAnEnergyScoreAlone) {
  MotionEstimate sure = Answer();
  sure.pose_cov.setZero();
  const StatedDensity density = DescribeStatedDensity(sure, TruthAway(kError), Bounds(1.0, 1.0), kInfinity);
  EXPECT_TRUE(density.IsSingular());
  EXPECT_EQ(density.sd_over_crb, 0.0);
  EXPECT_TRUE(std::isnan(density.log_det_cov));
  EXPECT_TRUE(std::isnan(density.log_score));
  EXPECT_NEAR(density.energy_score_deg, kDegPerRad * kError.norm(), 1e-6);
}

TEST(StatedDensity, WithoutATruthThereIsSharpnessAlone) {
  Truth rotation_alone = TruthAway(kError);
  rotation_alone.is_direction_known = false;
  for (const Truth& truth : {Truth{}, rotation_alone}) {
    const StatedDensity density = DescribeStatedDensity(Answer(), truth, {}, kNaN);
    EXPECT_TRUE(density.HasCovariance());
    EXPECT_GT(density.rotation_sd_deg, 0.0);
    EXPECT_TRUE(std::isnan(density.energy_score_deg));
    EXPECT_TRUE(std::isnan(density.log_score));
  }
}

TEST(StatedDensity, ARefusalAndAnInvalidAnswerStateNone) {
  for (const MotionStatus status : {MotionStatus::kNoCandidate, MotionStatus::kInvalidCovariance}) {
    MotionEstimate estimate = Answer();
    estimate.status = status;
    const StatedDensity density = DescribeStatedDensity(estimate, TruthAway(kError), Bounds(1.0, 1.0), kNaN);
    EXPECT_FALSE(density.HasCovariance());
    EXPECT_TRUE(std::isnan(density.rotation_sd_deg));
    EXPECT_TRUE(std::isnan(density.energy_score_deg));
  }
}

TEST(StatedDensity, ATruthWithAnErrorIsScoredByTheSum) {
  Truth truth = TruthAway(kError);
  truth.sd = TruthSd{.rotation_rad = Eigen::Vector3d::Constant(kRotationSd)};
  MotionEstimate wider = Answer();
  wider.pose_cov += truth.sd->CovarianceAt(wider.cam2_from_cam1);
  const StatedDensity density = DescribeStatedDensity(Answer(), truth, {}, 4.0);
  const StatedDensity of_sum = DescribeStatedDensity(wider, TruthAway(kError), {}, 4.0);
  EXPECT_NEAR(density.energy_score_deg, of_sum.energy_score_deg, 1e-9);
  EXPECT_NEAR(density.log_score, of_sum.log_score, 1e-9);
  EXPECT_LT(density.rotation_sd_deg, of_sum.rotation_sd_deg) << "what is stated is stated";
}

}  // namespace
}  // namespace rcme
