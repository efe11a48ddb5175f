#include "stats/multiple_testing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stats/distributions.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

void ExpectAdjusted(const std::vector<double>& p_values, const std::vector<double>& expected) {
  const std::vector<double> adjusted = HolmAdjusted(p_values);
  ASSERT_EQ(adjusted.size(), expected.size());
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(adjusted[i], expected[i], 1e-15) << i;
}

TEST(Holm, KnownAnswers) {
  // R: p.adjust(c(0.01, 0.04, 0.03, 0.005), "holm"); the same four are Wikipedia's example of the method.
  ExpectAdjusted({0.01, 0.04, 0.03, 0.005}, {0.03, 0.06, 0.06, 0.02});
  // R: p.adjust(c(0.01, 0.02, 0.03, 0.04, 0.05), "holm").
  ExpectAdjusted({0.01, 0.02, 0.03, 0.04, 0.05}, {0.05, 0.08, 0.09, 0.09, 0.09});
  ExpectAdjusted({0.7, 0.4, 0.9}, {1.0, 1.0, 1.0});
  ExpectAdjusted({0.2}, {0.2});
  ExpectAdjusted({}, {});
  EXPECT_THROW(HolmAdjusted({0.5, std::nan("")}), std::invalid_argument);
  EXPECT_THROW(HolmAdjusted({1.5}), std::invalid_argument);
}

TEST(Holm, FamilyWiseErrorRateIsKept) {
  // 20 tests, 4 of false hypotheses that are always rejected; 40 000 repetitions. Independent: 1 - (1 - 0.05
  // / 16)^16 = 0.0488 exactly (Bonferroni: 0.0393). Correlated (0.8): below that. Unadjusted: 1 - 0.95^16 =
  // 0.56.
  CoverageCount independent, correlated, unadjusted;
  RandomStream rng({.seed = 1, .purpose = 120});
  const auto least_null = [](const std::vector<double>& p) {
    return *std::min_element(p.begin() + 4, p.end());
  };
  for (int repetition = 0; repetition < 40'000; ++repetition) {
    const double common = rng.Normal();
    std::vector<double> p(20, 1e-9), dependent(20, 1e-9);
    for (size_t i = 4; i < 20; ++i) {
      p[i] = rng.Uniform();
      dependent[i] = NormalCdf(std::sqrt(0.8) * common + std::sqrt(0.2) * rng.Normal());
    }
    independent.Add(least_null(HolmAdjusted(p)) <= 0.05);
    correlated.Add(least_null(HolmAdjusted(dependent)) <= 0.05);
    unadjusted.Add(least_null(p) <= 0.05);
  }
  EXPECT_TRUE(independent.Admits(1.0 - std::pow(1.0 - 0.05 / 16.0, 16.0))) << independent;
  EXPECT_FALSE(independent.Admits(1.0 - std::pow(1.0 - 0.05 / 20.0, 16.0))) << "no power: Bonferroni";
  EXPECT_LT(correlated.interval().upper, 0.05) << correlated;
  EXPECT_GT(correlated.interval().lower, 0.005) << correlated;
  EXPECT_GT(unadjusted.interval().lower, 0.5) << unadjusted;
  RecordProperty("family_wise", std::to_string(independent.rate()));
}

}  // namespace
}  // namespace rcme
