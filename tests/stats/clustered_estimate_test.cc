// Known answers:  /usr/bin/python3 tests/known_answers/forecasts.py
#include "stats/clustered_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "stats/moments.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(ClusteredEstimate, KnownAnswers) {
  const std::vector<double> numbers = {1, 1, 2, 3, 3, 3, 4, 5, 6, 6, 7, 8, 9, 9, 10, 0};
  const std::vector<std::int64_t> clusters = {0, 0, 1, 1, 1, 2, 3, 3, 3, 4, 5, 5, 6, 6, 7, 8};
  const ClusteredEstimate mean = MeasureClusteredMean(numbers, clusters);
  EXPECT_NEAR(mean.value, 4.8125, 1e-12);
  EXPECT_NEAR(mean.standard_error, 1.055874982543, 1e-11);
  EXPECT_NEAR(mean.interval.lower, 2.377647924178, 1e-9);
  EXPECT_NEAR(mean.interval.upper, 7.247352075822, 1e-9);
  EXPECT_EQ(mean.n, 16);
  EXPECT_EQ(mean.num_clusters, 9);
  // In another order, with other names of the clusters.
  const std::vector<double> turned(numbers.rbegin(), numbers.rend());
  std::vector<std::int64_t> names(clusters.rbegin(), clusters.rend());
  for (std::int64_t& name : names) name = (name * 7) % 9 - 4;
  EXPECT_NEAR(MeasureClusteredMean(turned, names).standard_error, mean.standard_error, 1e-14);
}

TEST(ClusteredEstimate, OfSingleNumbersIsStudents) {
  RandomStream rng({.seed = 1, .purpose = 400});
  Moments moments;
  std::vector<double> numbers;
  std::vector<std::int64_t> clusters;
  for (int i = 0; i < 37; ++i) {
    numbers.push_back(rng.Normal());
    clusters.push_back(1000 - i);
    moments.Add(numbers.back());
  }
  const ClusteredEstimate mean = MeasureClusteredMean(numbers, clusters, 0.9);
  EXPECT_NEAR(mean.standard_error, moments.standard_error(), 1e-14);
  EXPECT_NEAR(mean.interval.lower, StudentInterval(moments, 0.9).lower, 1e-13);
  EXPECT_NEAR(mean.interval.upper, StudentInterval(moments, 0.9).upper, 1e-13);
}

TEST(ClusteredEstimate, OneClusterTellsNothing) {
  const ClusteredEstimate mean =
      MeasureClusteredMean(std::vector<double>{1, 2, 6}, std::vector<std::int64_t>(3, 5));
  EXPECT_EQ(mean.value, 3.0);
  EXPECT_TRUE(std::isnan(mean.standard_error));
  EXPECT_TRUE(mean.interval.Contains(-1e300) && mean.interval.Contains(1e300));
  EXPECT_TRUE(std::isnan(MeasureClusteredMean({}, {}).value));
  EXPECT_THROW(MeasureClusteredMean(std::vector<double>{1.0}, {}), std::invalid_argument);
}

// 40 scenes of five, half of the variance common to a scene: 4,000 repetitions. Numbers taken as independent
// cover 0.80.
TEST(ClusteredEstimate, CoversWhereNumbersShareAScene) {
  CoverageCount covered, as_independent;
  RandomStream rng({.seed = 1, .purpose = 401});
  std::vector<double> numbers(200);
  std::vector<std::int64_t> scenes(200), own(200);
  for (int repetition = 0; repetition < 4000; ++repetition) {
    double common = 0.0;
    for (size_t i = 0; i < 200; ++i) {
      if (i % 5 == 0) common = rng.Normal();
      numbers[i] = common + rng.Normal();
      scenes[i] = static_cast<std::int64_t>(i / 5), own[i] = static_cast<std::int64_t>(i);
    }
    covered.Add(MeasureClusteredMean(numbers, scenes).interval.Contains(0.0));
    as_independent.Add(MeasureClusteredMean(numbers, own).interval.Contains(0.0));
  }
  EXPECT_TRUE(covered.Admits(0.95)) << covered;
  EXPECT_FALSE(covered.Admits(0.92)) << "no power";
  EXPECT_LT(as_independent.rate(), 0.84) << as_independent;
}

}  // namespace
}  // namespace rcme
