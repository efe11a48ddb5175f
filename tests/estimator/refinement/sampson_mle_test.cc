#include "estimator/refinement/sampson_mle.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "estimator/refinement/reprojection_mle.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(RefineBySampson, IsWhatReprojectionErrorGives) {
  // Two optimisations with nothing in common but the noise model: they differ by much less than either is
  // uncertain, and report the same covariance.
  RandomStream rng({.seed = 1, .purpose = 920});
  for (int i = 0; i < 20; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 60});
    AddNoise(0.2, rng, &random.problem);
    std::vector<int> all(60);
    std::iota(all.begin(), all.end(), 0);
    const RefinedMotion points = RefineByReprojection(random.problem, all, random.pose_true, Loss::kSquared);
    const RefinedMotion sampson = RefineAllBySampson(random.problem, random.pose_true);
    ASSERT_TRUE(points.converged && sampson.converged);
    const Vector5d difference = LocalCoordinates(points.cam2_from_cam1, sampson.cam2_from_cam1);
    EXPECT_LT(NormalizedErrorSquared(difference, points.pose_cov), 0.01 * 0.01 * 5.0);
    // Ratio of the two covariances in every direction, 5 on average.
    const Matrix5d ratio = points.pose_cov.inverse() * sampson.pose_cov;
    EXPECT_NEAR(ratio.trace(), 5.0, 0.25);
  }
}

// Matches whose points in both images are more than 20 sigma away from the epipoles.
std::vector<int> AwayFromTheEpipoles(const MotionProblem& problem, const RelativePose& pose) {
  const Eigen::Vector2d epipole1 = problem.camera1.Project(pose.R.transpose() * pose.t);
  const Eigen::Vector2d epipole2 = problem.camera2.Project(pose.t);
  std::vector<int> away;
  for (int i = 0; i < static_cast<int>(problem.matches.size()); ++i) {
    const Correspondence& match = problem.matches[static_cast<size_t>(i)];
    const double distance = std::min((match.x1_px - epipole1).norm(), (match.x2_px - epipole2).norm());
    if (distance > 20.0 * problem.sigma_px) away.push_back(i);
  }
  return away;
}

// Distance of two motions in standard deviations, root mean square of the five directions.
double Apart(const RelativePose& a, const RelativePose& b, const Matrix5d& cov) {
  return std::sqrt(NormalizedErrorSquared(LocalCoordinates(a, b), cov) / 5.0);
}

TEST(RefineBySampson, IsWithinOnePercentOfBundleAdjustmentAwayFromTheEpipoles) {
  // Median, 99 % and maximum over 150 problems with all their matches (500 matches: 400 problems):
  //
  //   sigma    50 matches             200 matches            500 matches
  //   0.1 px   3e-5, 1.6e-4, 3.6e-4   6e-5, 2.3e-4, 4.2e-4   8e-5, 4.8e-4, 7.2e-4 (60 problems)
  //   0.5 px   1.5e-4, 7e-4, 9e-4     2.8e-4, 1.5e-3, 2.2e-3 4.7e-4, 2.9e-3, 1.4e-2 (1 beyond 0.01)
  //   1 px     2.9e-4, 1.3e-3, 1.9e-3 6e-4, 4e-3, 9.5e-3     9.5e-4, 1.1e-2, 0.13 (5 beyond 0.01)
  //
  // Each of those six has a match within 8 sigma of an epipole, where |J| is no distance any more; without
  // the matches within 20 sigma all are below 0.007. One of another 60 problems (1 px, 500 matches) was 0.49
  // apart.
  for (const double sigma_px : {0.1, 0.5, 1.0}) {
    for (const int n : {50, 200, 500}) {
      RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(n), .purpose = 924});
      for (int i = 0; i < 30; ++i) {
        RandomProblem random = MakeRandomProblem(rng, {.num_matches = n});
        AddNoise(sigma_px, rng, &random.problem);
        const std::vector<int> indices = AwayFromTheEpipoles(random.problem, random.pose_true);
        const RefinedMotion sampson =
            RefineBySampson(random.problem, indices, random.pose_true, Loss::kSquared);
        const RefinedMotion bundle =
            RefineByReprojection(random.problem, indices, random.pose_true, Loss::kSquared, 1e-16);
        ASSERT_TRUE(sampson.converged && bundle.converged);
        EXPECT_LE(Apart(bundle.cam2_from_cam1, sampson.cam2_from_cam1, bundle.pose_cov), 0.01)
            << sigma_px << " px, " << n << " matches, problem " << i;
        EXPECT_GT(Apart(random.pose_true, sampson.cam2_from_cam1, bundle.pose_cov), 0.1) << "has not moved";
      }
    }
  }
}

// With Cauchy's loss too, both minimise the same: of 60 matches every fifth is 3 to 6 sigma off in image 2,
// where the scale of the loss decides how much it pulls.
TEST(RefineBySampson, RobustlyTooIsWhatReprojectionErrorGives) {
  RandomStream rng({.seed = 1, .purpose = 926});
  for (int i = 0; i < 10; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 60});
    AddNoise(0.2, rng, &random.problem);
    for (size_t k = 0; k < 60; k += 5) {
      random.problem.matches[k].x2_px += rng.Uniform(0.6, 1.2) * RandomDirection(rng).head<2>().normalized();
    }
    const std::vector<int> away = AwayFromTheEpipoles(random.problem, random.pose_true);
    const RefinedMotion points =
        RefineByReprojection(random.problem, away, random.pose_true, Loss::kCauchy, 1e-16);
    const RefinedMotion sampson = RefineBySampson(random.problem, away, random.pose_true, Loss::kCauchy);
    const RefinedMotion squared = RefineBySampson(random.problem, away, random.pose_true, Loss::kSquared);
    ASSERT_TRUE(points.converged && sampson.converged);
    EXPECT_LT(Apart(points.cam2_from_cam1, sampson.cam2_from_cam1, points.pose_cov), 0.06) << i;
    EXPECT_GT(Apart(squared.cam2_from_cam1, sampson.cam2_from_cam1, points.pose_cov), 0.1) << "no power";
  }
}

// Cauchy's scale is the one that keeps 95 % of the efficiency on normal residuals (Holland & Welsch 1977):
// (E psi')^2 / E psi^2 with psi = r / (1 + r^2 / c^2).
TEST(CauchyScale, KeepsNinetyFivePercentOfTheEfficiency) {
  const double c2 = kCauchyScale * kCauchyScale;
  double slope = 0.0, square = 0.0;
  for (double r = -12.0; r <= 12.0; r += 1e-3) {
    const double density = 1e-3 * std::exp(-0.5 * r * r) / std::sqrt(2.0 * std::numbers::pi);
    const double w = 1.0 / (1.0 + r * r / c2);
    slope += density * (2.0 * w * w - w);
    square += density * r * r * w * w;
  }
  EXPECT_NEAR(slope * slope / square, 0.95, 1e-3);
}

TEST(RefineBySampson, CoversWhereNoiseIsSmall) {
  // False alarm 1e-4 a size; a covariance off by a factor of 1.25 covers 0.978, of 0.8 covers 0.907, and the
  // interval is 0.025 wide: power above 0.99.
  for (const int m : {8, 40}) {
    RandomStream rng({.seed = 1, .purpose = 921});
    CoverageCount count, count_larger, count_smaller;
    const double limit = ChiSquareQuantile(5, 0.95);
    for (int i = 0; i < 5'000; ++i) {
      RandomProblem random = MakeRandomProblem(rng, {.num_matches = m});
      AddNoise(1e-4, rng, &random.problem);
      const RefinedMotion refined = RefineAllBySampson(random.problem, random.pose_true);
      const double nees = NormalizedErrorSquared(LocalCoordinates(refined.cam2_from_cam1, random.pose_true),
                                                 refined.pose_cov);
      count.Add(refined.converged && nees <= limit);
      count_larger.Add(refined.converged && nees / 1.25 <= limit);
      count_smaller.Add(refined.converged && nees / 0.8 <= limit);
    }
    EXPECT_TRUE(count.Admits(0.95)) << m << " points: " << count;
    EXPECT_FALSE(count_larger.Admits(0.95)) << "no power";
    EXPECT_FALSE(count_smaller.Admits(0.95)) << "no power";
  }
}

TEST(RefineBySampson, ConvergesFromAWrongStart) {
  RandomStream rng({.seed = 1, .purpose = 922});
  for (int i = 0; i < 50; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 40});
    Vector5d off;
    for (double& x : off) x = 0.02 * rng.Normal();
    const RefinedMotion refined = RefineAllBySampson(random.problem, Retract(random.pose_true, off));
    ASSERT_TRUE(refined.converged);
    EXPECT_LT(LocalCoordinates(refined.cam2_from_cam1, random.pose_true).norm(), 1e-6);
  }
}

TEST(RefineBySampson, ReturnsTheStartWithoutConvergence) {
  RandomStream rng({.seed = 1, .purpose = 923});
  RandomProblem random = MakeRandomProblem(rng);
  random.problem.matches[2].x1_px.x() = std::numeric_limits<double>::quiet_NaN();
  const RefinedMotion refined = RefineAllBySampson(random.problem, random.pose_true);
  EXPECT_FALSE(refined.converged);
  EXPECT_EQ(refined.cam2_from_cam1.R, random.pose_true.R);
}

}  // namespace
}  // namespace rcme
