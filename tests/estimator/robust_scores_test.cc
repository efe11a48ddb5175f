#include "estimator/robust_scores.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "stats/random.h"

namespace rcme {
namespace {

Thresholds MakeThresholds(double point, double range) {
  Thresholds thresholds;
  thresholds.point = point;
  thresholds.outlier_cost = std::log(range);
  return thresholds;
}

double DensityAt(double e) { return std::exp(-0.5 * e * e) / std::sqrt(2.0 * std::numbers::pi); }

// 0 + 1 + 3 within 3.84, two beyond it.
TEST(MsacScore, IsTheTruncatedSum) {
  const double far = std::numeric_limits<double>::infinity();
  EXPECT_DOUBLE_EQ(MsacScore::Cost(std::vector<double>{0.0, 1.0, 3.0, 5.0, far}, MakeThresholds(3.84, 1e3)),
                   4.0 + 2.0 * 3.84);
}

// Of one match each step multiplies the odds gamma / (1 - gamma) by phi v, from 1 on.
TEST(MlesacScore, OfOneMatchIsAClosedForm) {
  for (const double e : {0.0, 1.0, 3.0}) {
    const double v = 50.0, phi = DensityAt(e);
    const double odds = std::pow(phi * v, 3);
    const double expected = -std::log((odds * phi + 1.0 / v) / (1.0 + odds));
    EXPECT_NEAR(MlesacScore::Cost(std::vector<double>{e * e}, MakeThresholds(3.84, v)), expected, 1e-12) << e;
  }
}

// 70 % right, the rest uniform over the range: the cost is that of the true share but for what three steps
// and the estimate of one parameter change, 1/2 chi2_1 of 20,000 in expectation.
TEST(MlesacScore, FindsTheShareOfRightMatches) {
  constexpr double kRange = 1000.0, kShare = 0.7;
  RandomStream rng({.seed = 1, .purpose = 2760});
  std::vector<double> squared;
  double of_truth = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    const double e = i < kShare * 20'000 ? rng.Normal() : rng.Uniform(-0.5 * kRange, 0.5 * kRange);
    squared.push_back(e * e);
    of_truth -= std::log(kShare * DensityAt(e) + (1.0 - kShare) / kRange);
  }
  const double cost = MlesacScore::Cost(squared, MakeThresholds(3.84, kRange));
  EXPECT_NEAR(cost, of_truth, 10.0);
}

TEST(MlesacScore, IsFiniteWhereAllAreWrong) {
  const std::vector<double> squared = {1e5, 1e300, std::numeric_limits<double>::infinity()};
  EXPECT_TRUE(std::isfinite(MlesacScore::Cost(squared, MakeThresholds(3.84, 1e3))));
}

}  // namespace
}  // namespace rcme
