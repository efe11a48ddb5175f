#include "estimator/observability.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "estimator/estimators/rcme.h"
#include "estimator/kernels/block_matches.h"
#include "estimator/kernels/rotation_equations.h"
#include "estimator/loop_inspection.h"
#include "estimator/reference_matches.h"
#include "estimator/refinement/sampson_equations.h"
#include "stats/distributions.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// Noisy matches of a rotation without a translation, both cameras different.
struct RotationCase {
  MotionProblem problem;
  Eigen::Matrix3d R_true;
};
RotationCase MakeRotationCase(int num_matches, RandomStream& rng) {
  RandomProblem random =
      MakeRandomProblem(rng, {.num_matches = num_matches, .min_depth = 1e9, .max_depth = 2e9});
  AddNoise(0.5, rng, &random.problem);
  return {random.problem, random.pose_true.R};
}

// d2, and G' C^-1 e and G' C^-1 G, with derivatives by central differences: nothing of the kernel's.
struct Oracle {
  double d2;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
};
Oracle EvaluateOracle(const MotionProblem& p, const Eigen::Matrix3d& R, const Correspondence& match) {
  const auto transfer = [&](const Eigen::Matrix3d& rotation, const Eigen::Vector2d& x1) {
    return p.camera2.Project(rotation * p.camera1.Ray(x1));
  };
  Eigen::Matrix2d J;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d h = 1e-3 * Eigen::Vector2d::Unit(i);
    J.col(i) = (transfer(R, match.x1_px + h) - transfer(R, match.x1_px - h)) / 2e-3;
  }
  Eigen::Matrix<double, 2, 3> G;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d w = 1e-5 * Eigen::Vector3d::Unit(k);
    G.col(k) = (transfer(RotationFromVector(w) * R, match.x1_px) -
                transfer(RotationFromVector(-w) * R, match.x1_px)) /
               2e-5;
  }
  const Eigen::Matrix2d C = p.sigma_px * p.sigma_px * (Eigen::Matrix2d::Identity() + J * J.transpose());
  const Eigen::Vector2d e = match.x2_px - transfer(R, match.x1_px);
  return {e.dot(C.inverse() * e), -G.transpose() * C.inverse() * e, G.transpose() * C.inverse() * G};
}

class Rotations : public OnEveryTarget {};

TEST_F(Rotations, EquationsAreTheirDefinition) {
  RandomStream rng({.seed = 1, .purpose = 1402});
  for (const int n : {1, 7, 8, 9, 30}) {
    const RotationCase c = MakeRotationCase(n, rng);
    const Eigen::Matrix3d R = RotationFromVector(Eigen::Vector3d(0.01, -0.02, 0.015)) * c.R_true;
    const MatchBlocks matches(c.problem);
    double energy = 0.0;
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero(), robust_gradient = gradient;
    Eigen::Matrix3d hessian = Eigen::Matrix3d::Zero();
    std::vector<double> squared;
    for (const Correspondence& match : c.problem.matches) {
      const Oracle oracle = EvaluateOracle(c.problem, R, match);
      squared.push_back(oracle.d2);
      energy += oracle.d2;
      gradient += oracle.gradient;
      robust_gradient += oracle.gradient / (1.0 + oracle.d2 / (kCauchyScale * kCauchyScale));
      hessian += oracle.hessian;
    }
    Run([&] {
      const RotationEquations at = LinearizeRotation(matches, matches.All(), R, Loss::kSquared);
      EXPECT_NEAR(at.energy, energy, 1e-6 * energy);
      EXPECT_LT((at.gradient - gradient).norm(), 1e-6 * gradient.norm());
      EXPECT_LT((at.hessian - hessian).norm(), 1e-6 * hessian.norm());
      const Eigen::Vector3d robust = LinearizeRotation(matches, matches.All(), R, Loss::kCauchy).gradient;
      EXPECT_LT((robust - robust_gradient).norm(), 1e-6 * robust_gradient.norm());
      for (const double factor : {0.999, 1.001}) {  // each match on the right side of its own distance
        for (size_t i = 0; i < squared.size(); ++i) {
          InlierScan scan(matches);
          ScanRotation(matches, R, factor * squared[i], &scan);
          EXPECT_EQ(scan.inliers[i / 8] >> (i % 8) & 1, factor > 1.0) << i;
        }
      }
    });
  }
}

RotationFit FitToAll(const MotionProblem& problem, const Eigen::Matrix3d& start, double threshold) {
  const MatchBlocks blocks(problem);
  const BlockMatches matches(problem, blocks, RefinementError::kSampson);
  const RotationFit fit = FitRotation(matches, matches.All(), start, threshold);
  const ReferenceMatches reference(problem, RefinementError::kSampson);
  const RotationFit expected = FitRotation(reference, reference.All(), start, threshold);
  EXPECT_LT(RotationAngleBetween(fit.R, expected.R), 1e-9);
  EXPECT_LT((fit.rotation_cov - expected.rotation_cov).norm(), 1e-9 * expected.rotation_cov.norm());
  EXPECT_NEAR(fit.energy, expected.energy, 1e-9 * expected.energy);
  EXPECT_EQ(fit.num_within, expected.num_within);
  EXPECT_EQ(fit.num_fitted, expected.num_fitted);
  return fit;
}

// Squared errors over their covariance, 300 trials of three degrees of freedom: a covariance 25 % off in
// variance is seen with probability .99, and a right one passes with .9999.
TEST_F(Rotations, TheirCovarianceIsThatOfTheirError) {
  RandomStream rng({.seed = 1, .purpose = 1403});
  double sum = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    const RotationCase c = MakeRotationCase(40, rng);
    const Eigen::Matrix3d start = RotationFromVector(0.01 * RandomDirection(rng)) * c.R_true;
    const RotationFit fit = FitToAll(c.problem, start, 30.0);
    const Eigen::Vector3d error = VectorFromRotation(c.R_true * fit.R.transpose());
    sum += error.dot(fit.rotation_cov.inverse() * error);
  }
  EXPECT_GT(sum, ChiSquareQuantile(900, 0.00005));
  EXPECT_LT(sum, ChiSquareQuantile(900, 0.99995));
}

TEST_F(Rotations, AThirdOfWrongMatchesIsLeftOut) {
  RandomStream rng({.seed = 1, .purpose = 1404});
  for (int trial = 0; trial < 20; ++trial) {
    RotationCase c = MakeRotationCase(90, rng);
    for (size_t i = 0; i < 90; i += 3)
      c.problem.matches[i].x2_px << rng.Uniform(0.0, 799.0), rng.Uniform(0.0, 599.0);
    const Eigen::Matrix3d start = RotationFromVector(0.01 * RandomDirection(rng)) * c.R_true;
    const RotationFit fit = FitToAll(c.problem, start, 25.0);
    EXPECT_NEAR(fit.num_fitted, 60, 1) << trial;
    EXPECT_LT(RotationAngleBetween(fit.R, c.R_true), 0.001) << trial;
  }
}

// The energy's null distribution: chi2_{2k-3}. 400 trials at level .1: between 4 % and 18 % are rejected.
TEST_F(Rotations, TheEnergyOfNoiseHasTheStatedLaw) {
  RandomStream rng({.seed = 1, .purpose = 1405});
  int num_above = 0;
  for (int trial = 0; trial < 400; ++trial) {
    const RotationCase c = MakeRotationCase(20, rng);
    const RotationFit fit = FitToAll(c.problem, c.R_true, 1e6);
    num_above += fit.energy > ChiSquareQuantile(37, 0.9);
  }
  EXPECT_GT(num_above, 16);
  EXPECT_LT(num_above, 72);
}

MotionProblem PureRotationProblem(std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 1406});
  return MakeRotationCase(60, rng).problem;
}

std::unique_ptr<MotionEstimator> Make(Reading reading, Implementation implementation) {
  RansacOptions options;
  options.reading = reading;
  options.implementation = implementation;
  return MakeRcme(options, SampleTest::kOff);
}

MotionEstimate EstimateFrom(const MotionEstimator& estimator, const MotionProblem& problem) {
  RandomStream rng({.seed = 1, .purpose = 1407});
  return estimator.Estimate(problem, rng);
}

TEST(DirectionNotObservable, GivesTheRotationAndNoDirection) {
  const MotionProblem problem = PureRotationProblem(1);
  const auto estimator = Make(Reading::kRankAware, Implementation::kFast);
  const MotionEstimate estimate = EstimateFrom(*estimator, problem);
  ASSERT_EQ(estimate.status, MotionStatus::kDirectionNotObservable) << estimate.message;
  EXPECT_TRUE(estimate.cam2_from_cam1.R.allFinite());
  EXPECT_TRUE((estimate.pose_cov.topLeftCorner<3, 3>().diagonal().array() > 0.0).all());
  EXPECT_TRUE(estimate.cam2_from_cam1.t.array().isNaN().all());
  EXPECT_TRUE(estimate.pose_cov.rightCols<2>().array().isNaN().all());
  EXPECT_TRUE(estimate.pose_cov.bottomRows<2>().array().isNaN().all());
}

TEST(DirectionNotObservable, NotAsPrintedUnlessAskedFor) {
  RansacOptions options;
  EXPECT_EQ(options.ObservabilityLevelOrDefault(), 1.0);
  EXPECT_EQ(options.ChanceLevelOrDefault(), 1.0);
  options.reading = Reading::kRankAware;
  EXPECT_EQ(options.ObservabilityLevelOrDefault(), 0.001);
  EXPECT_EQ(options.ChanceLevelOrDefault(), 0.001);
  FindParameter(MotionTestParameters(options, true), "chance_significance_level").SetFromText("off");
  EXPECT_EQ(options.ChanceLevelOrDefault(), 1.0);
  EXPECT_EQ(FindParameter(MotionTestParameters(options, true), "chance_significance_level").Value(), "off");
}

TEST(DirectionNotObservable, TheSameFromTheReferenceAndFromPieces) {
  int num = 0;
  for (std::uint32_t trial = 1; trial <= 6; ++trial) {
    const MotionProblem problem = PureRotationProblem(trial);
    const auto fast = Make(Reading::kRankAware, Implementation::kFast);
    const MotionEstimate whole = EstimateFrom(*fast, problem);
    const MotionEstimate reference =
        EstimateFrom(*Make(Reading::kRankAware, Implementation::kReference), problem);
    RandomStream rng({.seed = 1, .purpose = 1407});
    const LoopInspection& inspection = *FindInspection(*fast);
    Refinements refinements;
    const MotionEstimate pieces =
        inspection.Finish(problem, inspection.Decide(inspection.Trace(problem, rng)), &refinements);
    for (const MotionEstimate& other : {reference, pieces}) {
      EXPECT_EQ(other.status, whole.status) << trial;
      EXPECT_LT(RotationAngleBetween(other.cam2_from_cam1.R, whole.cam2_from_cam1.R), 1e-9) << trial;
    }
    num += whole.status == MotionStatus::kDirectionNotObservable;
  }
  EXPECT_GE(num, 5);
}

double ComputeNoiseShare(const MotionProblem& problem, const std::vector<int>& fitted,
                         const RelativePose& pose, const Eigen::Matrix2d& direction_cov) {
  return NoiseShareOfDirection(direction_cov, SumDirectionNoise(problem, fitted, pose, direction_cov));
}

// Noise alone is all of it; with a parallax of sixty standard deviations it is next to nothing.
TEST(NoiseShareOfDirection, IsOneWithoutParallaxAndNothingWithMuch) {
  RandomStream rng({.seed = 1, .purpose = 1408});
  double sum = 0.0;
  for (int trial = 0; trial < 40; ++trial) {
    // Far points: what the direction's information holds is noise. One direction is fitted to it, hence
    // "about".
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 400, .min_depth = 1e9, .max_depth = 2e9});
    AddNoise(0.5, rng, &random.problem);
    const std::vector<int> all = ReferenceMatches(random.problem, RefinementError::kSampson).All();
    const Matrix5d information = SampsonInformation(random.problem, all, random.pose_true);
    const Eigen::Matrix2d direction_cov = information.bottomRightCorner<2, 2>().inverse();
    sum += ComputeNoiseShare(random.problem, all, random.pose_true, direction_cov) / 40.0;
  }
  EXPECT_GT(
      sum,
      0.95);  // the greater of two eigenvalues whose mean is 1; 0.5 to 0.7 without the noise of one image
  EXPECT_LT(sum, 1.4);
  RandomProblem near = MakeRandomProblem(rng, {.num_matches = 400});
  AddNoise(0.5, rng, &near.problem);
  const std::vector<int> all = ReferenceMatches(near.problem, RefinementError::kSampson).All();
  const Matrix5d cov = SampsonInformation(near.problem, all, near.pose_true).inverse();
  EXPECT_LT(ComputeNoiseShare(near.problem, all, near.pose_true, cov.bottomRightCorner<2, 2>()), 0.02);
}

class DirectionNoise : public OnEveryTarget {};

// As one match at a time gives it, for a covariance that leaves matches next to an epipole out, and one that
// does not.
TEST_F(DirectionNoise, IsThatOfTheReference) {
  RandomStream rng({.seed = 1, .purpose = 1409});
  for (const int n : {1, 8, 61}) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = n});
    AddNoise(0.5, rng, &random.problem);
    std::vector<int> fitted;
    for (int i = 0; i < n; i += 1 + i % 3) fitted.push_back(i);
    for (const double variance : {1e-9, 1e-2, 3e-1}) {
      Eigen::Matrix2d cov;
      cov << variance, 0.3 * variance, 0.3 * variance, 0.5 * variance;
      const Eigen::Matrix2d expected = SumDirectionNoise(random.problem, fitted, random.pose_true, cov);
      Run([&] {
        const MatchBlocks blocks(random.problem);
        const BlockMatches matches(random.problem, blocks, RefinementError::kSampson);
        const Eigen::Matrix2d noise =
            matches.SumDirectionNoise(matches.MakeSet(fitted), random.pose_true, cov);
        EXPECT_LE((noise - expected).norm(), 1e-9 * expected.norm()) << n << ", " << variance;
      });
    }
  }
}

// The test without a fit says the same as the test with one, wherever a rotation is one of many matches, of
// half, or of nearly all; and it is spared the fit where there is much parallax.
TEST(RotationTest, TheBoundChangesNoVerdict) {
  RandomStream rng({.seed = 1, .purpose = 1412});
  int num_spared = 0, num_explained = 0;
  for (int trial = 0; trial < 120; ++trial) {
    const double depth = std::pow(10.0, trial % 12 / 4.0 - 0.5);
    RandomProblem random = MakeRandomProblem(
        rng, {.num_matches = 20 + 4 * trial, .min_depth = 4.0 * depth, .max_depth = 16.0 * depth});
    AddNoise(0.5, rng, &random.problem);
    const MatchBlocks blocks(random.problem);
    const BlockMatches matches(random.problem, blocks, RefinementError::kSampson);
    const bool may = MayRotationExplain(matches, random.pose_true, 0.05);
    const bool does = TestRotationAlone(matches, random.pose_true, 0.05).explains_matches;
    EXPECT_TRUE(may || !does) << trial;
    num_spared += !may;
    num_explained += does;
  }
  EXPECT_GT(num_spared, 40);
  EXPECT_GT(num_explained, 10);
}

}  // namespace
}  // namespace rcme
