#include "estimator/linear_motion.h"

#include <gtest/gtest.h>

#include "estimator/hypothesis.h"
#include "estimator/solvers/eight_point.h"
#include "stats/consistency.h"
#include "stats/distributions.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(EstimateLinearMotion, IsTheHypothesisOfAMinimalSample) {
  RandomStream rng({.seed = 1, .purpose = 910});
  for (int i = 0; i < 100; ++i) {
    RandomProblem random = MakeRandomProblem(rng);
    AddNoise(0.5, rng, &random.problem);
    Hypothesis<EightPoint> hypothesis =
        InstantiateModel<EightPoint>(random.problem, {{0, 1, 2, 3, 4, 5, 6, 7}}).value();
    PropagateCovariance(random.problem, &hypothesis);
    const LinearMotion motion = EstimateLinearMotion(random.problem).value();
    const double tolerance = 1e-12 / motion.fit.conditioning;
    EXPECT_LT((motion.f_cov - hypothesis.f_cov).norm(), tolerance * hypothesis.f_cov.norm());
    double nearest = 1.0;
    for (const RelativePose& pose : motion.poses) {
      nearest = std::min(nearest, LocalCoordinates(hypothesis.pose, pose).norm());
    }
    EXPECT_LT(nearest, 100.0 * tolerance);
    EXPECT_LT(motion.fit.LocalCoordinates(hypothesis.model.f).norm(), tolerance);
  }
}

TEST(EstimateLinearMotion, CovarianceOfFCoversInTheLimitOfSmallNoise) {
  // Also with more points than unknowns, where equal weights are not optimal but their covariance is still G
  // D G'. False alarm 1e-4 a size; a covariance off by a factor of 1.25 covers 0.983, of 0.8 covers 0.885,
  // and the interval is 0.02 wide: power 1.
  for (const int m : {12, 40}) {
    RandomStream rng({.seed = 1, .purpose = 911});
    CoverageCount count, count_larger, count_smaller;
    const double limit = ChiSquareQuantile(8, 0.95);
    for (int i = 0; i < 8'000; ++i) {
      RandomProblem random = MakeRandomProblem(rng, {.num_matches = m});
      AddNoise(1e-4, rng, &random.problem);
      const LinearMotion motion = EstimateLinearMotion(random.problem).value();
      const Eigen::VectorXd error = motion.fit.LocalCoordinates(ComputeLinearModel(random.pose_true));
      const double nees = NormalizedErrorSquared(error, Eigen::MatrixXd(motion.LocalCovarianceOfF()));
      count.Add(nees <= limit);
      count_larger.Add(nees / 1.25 <= limit);
      count_smaller.Add(nees / 0.8 <= limit);
    }
    EXPECT_TRUE(count.Admits(0.95)) << m << " points: " << count;
    EXPECT_FALSE(count_larger.Admits(0.95)) << "no power";
    EXPECT_FALSE(count_smaller.Admits(0.95)) << "no power";
  }
}

TEST(EstimateLinearMotion, NothingFromADegenerateSample) {
  RandomStream rng({.seed = 1, .purpose = 912});
  RandomProblem random = MakeRandomProblem(rng);
  random.problem.matches[6] = random.problem.matches[2];
  EXPECT_FALSE(EstimateLinearMotion(random.problem));
}

}  // namespace
}  // namespace rcme
