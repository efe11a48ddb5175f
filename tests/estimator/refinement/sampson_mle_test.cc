#include "estimator/refinement/sampson_mle.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
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
