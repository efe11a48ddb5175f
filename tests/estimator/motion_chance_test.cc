#include "estimator/motion_chance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "estimator/kernels/agreement_chance.h"
#include "tests/test_support/every_target.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

// Share of pairs of a first point and a second one drawn uniformly from the rectangle of the second points
// that the scalar Sampson distance takes: an exact binomial draw, within five of its standard deviations and
// 4 % for the borders of the rectangle, where the band is cut slantwise.
TEST(MotionChance, IsTheShareOfRandomPointsThatAgree) {
  RandomStream rng({.seed = 1, .purpose = 1401});
  for (const double sigma_px : {0.5, 3.0}) {
    for (int trial = 0; trial < 4; ++trial) {
      RandomProblem random = MakeRandomProblem(rng, {.num_matches = 150});
      MotionProblem& problem = random.problem;
      problem.sigma_px = sigma_px;
      Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
      for (const Correspondence& match : problem.matches) {
        low = low.min(match.x2_px.array());
        high = high.max(match.x2_px.array());
      }
      const RelativePose pose = RandomPose(rng, 10.0);
      const Eigen::Matrix3d F =
          FundamentalFromEssential(EssentialFromPose(pose), problem.camera1, problem.camera2);
      const double threshold = 5.99, chance = ChanceOfAgreement(problem, pose, threshold);
      int count = 0;
      const int per_match = 1000, n = 150 * per_match;
      for (Correspondence match : problem.matches) {
        for (int i = 0; i < per_match; ++i) {
          match.x2_px << rng.Uniform(low.x(), high.x()), rng.Uniform(low.y(), high.y());
          count += SquaredSampsonDistance(F, match) <= threshold * sigma_px * sigma_px;
        }
      }
      const double share = static_cast<double>(count) / n;
      EXPECT_NEAR(chance, share, 5.0 * std::sqrt(share / n) + 0.04 * share) << sigma_px << ", " << trial;
    }
  }
}

class ChanceKernel : public OnEveryTarget {};

// Of motions that see most lines and few, of few matches and many.
TEST_F(ChanceKernel, IsTheReference) {
  RandomStream rng({.seed = 1, .purpose = 1415});
  for (const int n : {1, 2, 7, 64, 130, 500}) {
    for (int trial = 0; trial < 8; ++trial) {
      RandomProblem random = MakeRandomProblem(rng, {.num_matches = n});
      AddNoise(0.5, rng, &random.problem);
      const RelativePose pose = trial % 2 == 0 ? random.pose_true : RandomPose(rng, 90.0);
      for (const double threshold : {0.5, 5.99, 1e4}) {
        const double expected = ChanceOfAgreement(random.problem, pose, threshold);
        Run([&] {
          const MatchBlocks matches(random.problem);
          const Box box = BoxOfSecondPoints(random.problem);
          EXPECT_NEAR(ChanceOfAgreement(matches, pose, box, threshold), expected, 1e-9) << n << ", " << trial;
        });
      }
    }
  }
}

// By the sum itself, in long double: 320 C(n, 5) sum_{j >= k-5} C(n-5, j) p^j (1-p)^(n-5-j).
TEST(MotionChance, FalseAlarmsAreTheUnionBound) {
  for (const auto& [n, k, p] : {std::tuple{20, 9, 0.01}, {20, 20, 0.3}, {200, 14, 0.006}, {500, 40, 0.02}}) {
    long double tail = 0.0;
    for (int j = k - 5; j <= n - 5; ++j) {
      tail += std::exp(std::lgamma(n - 4.0L) - std::lgamma(j + 1.0L) - std::lgamma(n - 4.0L - j) +
                       j * std::log(static_cast<long double>(p)) +
                       (n - 5 - j) * std::log1p(-static_cast<long double>(p)));
    }
    const long double choices = 1.0L * n * (n - 1) * (n - 2) * (n - 3) * (n - 4) / 120.0L;
    EXPECT_NEAR(LogFalseAlarms(kMotions, n, k, p), static_cast<double>(std::log(320.0L * choices * tail)),
                1e-9);
  }
}

TEST(MotionChance, NoMoreMatchesThanFixTheModelProveNothing) {
  EXPECT_EQ(LogFalseAlarms(kMotions, 8, 5, 1e-6), std::numeric_limits<double>::infinity());
  EXPECT_EQ(LogFalseAlarms(kRotations, 8, 3, 1e-6), std::numeric_limits<double>::infinity());
  EXPECT_LT(LogFalseAlarms(kRotations, 8, 8, 1e-6), 0.0);
}

// Beyond the range of a double the bound goes on, above the tail (its log is that of a sum of n terms at
// most, each at most the bound) and falling.
TEST(MotionChance, TinyTailsAreBoundedFromAbove) {
  const double at_edge = LogFalseAlarms(kMotions, 2000, 300, 0.01),
               beyond = LogFalseAlarms(kMotions, 2000, 600, 0.01);
  EXPECT_LT(beyond, at_edge);
  EXPECT_LT(LogFalseAlarms(kMotions, 2000, 2000, 0.01), beyond);
  EXPECT_NEAR(LogFalseAlarms(kMotions, 2000, 2000, 0.01),
              1995.0 * std::log(0.01) + std::log(320.0 / 120.0) + 5.0 * std::log(2000.0), 0.01);
}

}  // namespace
}  // namespace rcme
