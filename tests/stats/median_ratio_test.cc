#include "stats/median_ratio.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

double ChiSquare5(RandomStream& rng) {
  double sum = 0.0;
  for (int k = 0; k < 5; ++k) {
    const double z = rng.Normal();
    sum += z * z;
  }
  return sum;
}

TEST(ComputeMedian, ByHand) {
  EXPECT_EQ(ComputeMedian({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(ComputeMedian({4.0, 1.0, 2.0, 3.0}), 2.5);
  EXPECT_TRUE(std::isnan(ComputeMedian({})));
}

TEST(RatioOfMedians, WithoutValuesThereIsNone) {
  RandomStream rng({.seed = 1, .purpose = 70});
  EXPECT_TRUE(std::isnan(RatioOfMedians({}, 0.95, 10, rng).value));
  const std::vector<UnitValues> units = {{{1.0}, {}}};
  EXPECT_TRUE(std::isnan(RatioOfMedians(units, 0.95, 10, rng).value));
}

TEST(RatioOfMedians, OfFourUnitsSaysNothing) {
  RandomStream rng({.seed = 1, .purpose = 70});
  const std::vector<UnitValues> four(4, {{2.0}, {1.0}}), five(5, {{2.0}, {1.0}});
  EXPECT_EQ(RatioOfMedians(four, 0.95, 10, rng).value, 2.0);
  EXPECT_EQ(RatioOfMedians(four, 0.95, 10, rng).interval.lower, 0.0);
  EXPECT_TRUE(std::isinf(RatioOfMedians(four, 0.95, 10, rng).interval.upper));
  EXPECT_EQ(RatioOfMedians(five, 0.95, 10, rng).interval.lower, 2.0);
}

// Thirty units of two values each whose observed ones have twice the variance, and nulls alike within a unit.
// The interval must cover the true ratio 2: nominal 0.90 to 0.99 for a bootstrap of so few units, 300
// repeats, at 1e-4; and exclude 1 nearly always: power.
TEST(RatioOfMedians, ItsIntervalCoversTheRatioOfVariances) {
  CoverageCount covers, excludes_one;
  for (std::uint32_t trial = 0; trial < 300; ++trial) {
    RandomStream rng({.seed = 1, .trial = trial, .purpose = 70});
    std::vector<UnitValues> units(30);
    for (UnitValues& unit : units) {
      for (int k = 0; k < 2; ++k) {
        unit.observed.push_back(2.0 * ChiSquare5(rng));
        unit.null.push_back(ChiSquare5(rng));
      }
    }
    const ComparedMedians ratio = RatioOfMedians(units, 0.95, 300, rng);
    covers.Add(ratio.interval.Contains(2.0));
    excludes_one.Add(ratio.interval.lower > 1.0);
  }
  EXPECT_GT(covers.interval().upper, 0.90) << covers;
  EXPECT_LT(covers.interval().lower, 0.99) << covers;
  EXPECT_GT(excludes_one.rate(), 0.9) << excludes_one;
}

}  // namespace
}  // namespace rcme
