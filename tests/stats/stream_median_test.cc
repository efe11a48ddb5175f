#include "stats/stream_median.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/measured_quantile.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

StreamMedian ComputeStreamMedian(const std::vector<double>& values) {
  StreamMedian median;
  for (const double x : values) median.Add(x);
  return median;
}

TEST(StreamMedian, ByHand) {
  const StreamMedian median = ComputeStreamMedian({4, 6, 20, 2, 30, 3});
  EXPECT_EQ(median.n(), 6);
  EXPECT_EQ(median.median(), 4.0);          // the third of six
  EXPECT_EQ(median.interval().lower, 2.0);  // 2 / 2^6 = 0.031: the least and the greatest
  EXPECT_EQ(median.interval().upper, 30.0);
  EXPECT_EQ(ComputeStreamMedian({1, 2, 3}).interval().upper, kInfinity) << "2 / 2^3 = 0.25";
  EXPECT_TRUE(std::isnan(StreamMedian().median()));
  EXPECT_EQ(ComputeStreamMedian({-5, -1, 0, 7, kInfinity}).median(), 0.0);
  EXPECT_EQ(ComputeStreamMedian({kInfinity, 1, kInfinity}).median(), kInfinity);
  EXPECT_THROW(ComputeStreamMedian({std::nan("")}), std::invalid_argument);
}

// Against the sorted numbers: the median is at most a cell nearer to zero, the interval encloses theirs and
// is wider by at most a cell at either end.
TEST(StreamMedian, IsThatOfTheSortedNumbersUpToACell) {
  constexpr double kCell = 1.0 / 256.0;
  for (std::uint32_t i = 0; i < 50; ++i) {
    RandomStream rng({.seed = 1, .trial = i, .purpose = 170});
    std::vector<double> values(300 + 37 * i);
    for (double& x : values) x = std::exp(2.0 * rng.Normal() + 1.0);
    const MeasuredQuantile sorted = MeasureQuantile(values, 0.5);
    const StreamMedian median = ComputeStreamMedian(values);
    EXPECT_LE(median.median(), sorted.value);
    EXPECT_GE(median.median(), sorted.value * (1.0 - kCell));
    EXPECT_LE(median.interval().lower, sorted.interval.lower);
    EXPECT_GE(median.interval().lower, sorted.interval.lower * (1.0 - kCell));
    EXPECT_GE(median.interval().upper, sorted.interval.upper);
    EXPECT_LE(median.interval().upper, sorted.interval.upper * (1.0 + kCell));
  }
}

// Times of calls: a law with a heavy tail, where mean +- Student covers far less than it says. Exact coverage
// of the order statistics for n = 21 is 0.9734.
TEST(StreamMedian, IntervalCoversForALawWithAHeavyTail) {
  CoverageCount covered;
  RandomStream rng({.seed = 1, .purpose = 171});
  for (int repetition = 0; repetition < 4000; ++repetition) {
    StreamMedian median;
    for (int i = 0; i < 21; ++i) median.Add(std::pow(1.0 - rng.Uniform(), -2.0));  // Pareto, no mean
    covered.Add(median.interval().Contains(4.0));
  }
  EXPECT_TRUE(covered.Admits(0.9734)) << covered;
  EXPECT_FALSE(covered.Admits(0.95)) << "no power";
}

TEST(StreamMedian, InGroupsAndAsText) {
  StreamMedian whole, merged;
  RandomStream rng({.seed = 2, .purpose = 171});
  for (int group = 0; group < 5; ++group) {
    StreamMedian part;
    for (int i = 0; i < 40; ++i) {
      const double x = i == 7 ? std::numeric_limits<double>::infinity() : rng.Uniform() - 0.3;
      part.Add(x);
      whole.Add(x);
    }
    merged.Merge(StreamMedian::FromText(part.Text()));
  }
  EXPECT_EQ(merged.Text(), whole.Text());
  EXPECT_EQ(merged.n(), whole.n());
  EXPECT_EQ(merged.median(), whole.median());
  EXPECT_EQ(merged.interval().upper, whole.interval().upper);
  EXPECT_EQ(StreamMedian::FromText("").n(), 0);
  for (const char* other : {"1", "1:2", "1:0x1p+0:0x1p+1", "0:0x1p+0:0x1p+0", "1:0x1p+0:0x1p+0x", "1:nan:nan",
                            "1:0x1p+0:0x1p+0 2:0x1p+0:0x1p+0", "1:0x1p+1:0x1p+1 1:0x1p+0:0x1p+0",
                            // Together 2^63 - 3, if the sum of the counts wraps around.
                            "9223372036854775807:1:1 9223372036854775807:2:2 9223372036854775807:4:4"})
    EXPECT_THROW(StreamMedian::FromText(other), std::invalid_argument) << other;
}

}  // namespace
}  // namespace rcme
