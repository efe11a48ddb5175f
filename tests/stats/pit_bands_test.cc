// Known answers in exact fractions:  python3 tests/known_answers/pit_bands.py
#include "stats/pit_bands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/distributions.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(PitBands, KnownAnswers) {
  const struct {
    int n, num_points;
    double confidence, gamma, coverage;
    std::vector<int> lower, upper;
  } kKnown[] = {{10, 5, 0.95, 0.050000, 0.958382899200, {0, 1, 3, 5, 10}, {5, 7, 9, 10, 10}},
                {20,
                 10,
                 0.9,
                 0.034290,
                 0.903589144820,
                 {0, 1, 2, 4, 5, 7, 9, 12, 15, 20},
                 {5, 8, 11, 13, 15, 16, 18, 19, 20, 20}},
                {50,
                 8,
                 0.95,
                 0.014427,
                 0.952273725840,
                 {1, 6, 11, 16, 23, 30, 37, 50},
                 {13, 20, 27, 34, 39, 44, 49, 50}},
                {5, 2, 0.99, 0.010000, 1.0, {0, 5}, {5, 5}}};
  for (const auto& known : kKnown) {
    const PitBands bands = SimultaneousPitBands(known.n, known.num_points, known.confidence);
    EXPECT_EQ(bands.lower, known.lower) << "n = " << known.n;
    EXPECT_EQ(bands.upper, known.upper) << "n = " << known.n;
    EXPECT_NEAR(bands.simultaneous_coverage, known.coverage, 1e-11);
    EXPECT_NEAR(bands.pointwise_level, known.gamma, 2e-6);
  }
}

TEST(PitBands, OnePointIsABinomialProbability) {
  // K = 2: the only free count is that at 1/2. P(4 <= X <= 6), X ~ Binomial(10, 1/2) = (210 + 252 + 210) /
  // 1024.
  EXPECT_NEAR(SimultaneousCoverage(10, {4, 10}, {6, 10}), 672.0 / 1024.0, 1e-14);
  EXPECT_NEAR(SimultaneousCoverage(2000, {0, 2000}, {2000, 2000}), 1.0, 1e-11);
  EXPECT_EQ(SimultaneousCoverage(10, {7, 10}, {6, 10}), 0.0);
}

TEST(PitBands, FalseAlarmRateIsTheComputedOne) {
  // 20 000 samples of true uniforms. Pointwise bands (gamma = alpha) would raise an alarm in 26 %
  // of them at n = 100, K = 20 and in 50 % at n = 1000, K = 100.
  for (const auto& [n, num_points] : {std::pair{100, 20}, {1000, 100}}) {
    const PitBands bands = SimultaneousPitBands(n, num_points, 0.95);
    EXPECT_GE(bands.simultaneous_coverage, 0.95);
    EXPECT_LT(bands.simultaneous_coverage, 0.96);
    CoverageCount alarms;
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(n), .purpose = 90});
    for (int repetition = 0; repetition < 20'000; ++repetition) {
      std::vector<double> values(static_cast<size_t>(n));
      for (double& u : values) u = rng.Uniform();
      alarms.Add(!CheckPit(values, bands).IsUniform());
    }
    EXPECT_TRUE(alarms.Admits(1.0 - bands.simultaneous_coverage)) << alarms;
    EXPECT_FALSE(alarms.Admits(0.06)) << "no power";
    EXPECT_FALSE(alarms.Admits(0.035)) << "no power";
    RecordProperty("alarms_n" + std::to_string(n), std::to_string(alarms.rate()));
  }
}

TEST(PitBands, HasPowerAndShowsWhere) {
  // n = 1000 normals, K = 50. Sigma off by 20 %: too many values in both tails. Mean off by 0.2 sigma: the
  // curve is too low in the middle.
  const PitBands bands = SimultaneousPitBands(1000, 50, 0.95);
  CoverageCount wide, shifted;
  RandomStream rng({.seed = 1, .purpose = 91});
  int num_high_below_half = 0, num_low_above_half = 0, num_below = 0;
  for (int repetition = 0; repetition < 500; ++repetition) {
    std::vector<double> too_wide(1000), moved(1000);
    for (size_t i = 0; i < 1000; ++i) {
      const double z = rng.Normal();
      too_wide[i] = NormalCdf(1.2 * z);
      moved[i] = NormalCdf(z + 0.2);
    }
    const PitCheck of_wide = CheckPit(too_wide, bands), of_moved = CheckPit(moved, bands);
    wide.Add(!of_wide.IsUniform());
    shifted.Add(!of_moved.IsUniform());
    for (const int i : of_wide.outside) {
      const auto at = static_cast<size_t>(i);
      num_high_below_half += bands.z[at] < 0.5 && of_wide.counts[at] > bands.upper[at] ? 1 : 0;
      num_low_above_half += bands.z[at] > 0.5 && of_wide.counts[at] < bands.lower[at] ? 1 : 0;
    }
    for (const int i : of_moved.outside) {
      num_below += of_moved.counts[static_cast<size_t>(i)] < bands.lower[static_cast<size_t>(i)] ? 1 : 0;
    }
  }
  EXPECT_GT(wide.interval().lower, 0.95) << wide;
  EXPECT_GT(shifted.interval().lower, 0.95) << shifted;
  EXPECT_GT(num_high_below_half, 500);
  EXPECT_GT(num_low_above_half, 500);
  EXPECT_GT(num_below, 500);
}

TEST(PitBands, LargeSamplesStayExact) {
  // The coverage over the whole range is 1 whatever was cut from the tables of increments.
  std::vector<int> lower(100, 0), upper(100, 100'000);
  lower.back() = 100'000;
  for (size_t i = 0; i + 1 < 100; ++i) {  // 12 standard deviations: all but 1e-30
    const double z = (static_cast<double>(i) + 1.0) / 100.0, width = 12.0 * std::sqrt(1e5 * z * (1.0 - z));
    lower[i] = static_cast<int>(1e5 * z - width), upper[i] = static_cast<int>(1e5 * z + width);
  }
  EXPECT_NEAR(SimultaneousCoverage(100'000, lower, upper), 1.0, 1e-8);
}

TEST(PitBands, CountsByHandAndBadNumbers) {
  const PitBands bands = SimultaneousPitBands(4, 2, 0.95);
  const PitCheck check = CheckPit({0.5, 0.51, 1.0, 0.0}, bands);  // <= 1/2: two, the border included
  EXPECT_EQ(check.counts, (std::vector<int>{2, 4}));
  EXPECT_TRUE(check.IsUniform());
  for (const double bad : {std::nan(""), -0.1, 1.1}) {
    EXPECT_EQ(CheckPit({0.5, 0.51, 1.0, bad}, bands).num_invalid, 1);
    EXPECT_FALSE(CheckPit({0.5, 0.51, 1.0, bad}, bands).IsUniform());
  }
  EXPECT_THROW(CheckPit({0.5}, bands), std::invalid_argument);
  EXPECT_THROW(SimultaneousPitBands(0, 10), std::invalid_argument);
  EXPECT_THROW(SimultaneousPitBands(100'001, 10), std::invalid_argument);
  EXPECT_THROW(SimultaneousPitBands(10, 1), std::invalid_argument);
  EXPECT_THROW(SimultaneousPitBands(10, 10, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
