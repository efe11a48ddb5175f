#include "stats/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "stats/random.h"

namespace rcme {
namespace {

double ChiSquare(RandomStream& rng, int degrees_of_freedom) {
  double sum = 0.0;
  for (int k = 0; k < degrees_of_freedom; ++k) {
    const double z = rng.Normal();
    sum += z * z;
  }
  return sum;
}

TEST(Coverage, CountsByHand) {
  // chi2_2 has the quantiles -2 ln(alpha) = 1.386, 3.219, 4.605, 5.991, 9.210 (closed form).
  Coverage coverage(2);
  for (const double statistic : {0.0, 1.38, 1.39, 3.21, 3.22, 4.61, 5.99, 6.0, 9.22, 50.0})
    coverage.Add(statistic);
  const auto levels = coverage.Levels();
  const std::int64_t kCovered[] = {2, 4, 5, 7, 8};
  const double kNominal[] = {0.5, 0.8, 0.9, 0.95, 0.99};
  for (size_t i = 0; i < levels.size(); ++i) {
    EXPECT_EQ(levels[i].num_covered, kCovered[i]);
    EXPECT_EQ(levels[i].n, 10);
    EXPECT_DOUBLE_EQ(levels[i].nominal, kNominal[i]);
    EXPECT_DOUBLE_EQ(levels[i].measured, static_cast<double>(kCovered[i]) / 10.0);
    EXPECT_EQ(levels[i].interval.lower, ExactBinomialInterval(kCovered[i], 10).lower);
    EXPECT_EQ(levels[i].interval.upper, ExactBinomialInterval(kCovered[i], 10).upper);
  }
}

TEST(Coverage, IsNominalForTheRightLawAndNotForAWrongOne) {
  // 200 000 statistics; the false-alarm rate is shared among the 5 levels and 4 laws. Errors 3 % too large,
  // and one degree of freedom too many, are seen at each level that matters (beyond 10 standard errors at
  // 0.95).
  constexpr double kConfidence = 1.0 - 1e-4 / 20.0;
  for (const int dof : {1, 3, 5, 8}) {
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(dof), .purpose = 80});
    Coverage right(dof), too_large(dof), wrong_dof(dof + 1);
    for (int i = 0; i < 200'000; ++i) {
      const double statistic = ChiSquare(rng, dof);
      right.Add(statistic);
      too_large.Add(1.03 * 1.03 * statistic);
      wrong_dof.Add(statistic);
    }
    for (const Coverage::Level& level : right.Levels(kConfidence)) {
      EXPECT_TRUE(level.IsNominal()) << "dof " << dof << ", nominal " << level.nominal << ": "
                                     << level.measured;
    }
    EXPECT_FALSE(too_large.Levels(kConfidence)[3].IsNominal()) << "no power, dof " << dof;
    for (const Coverage::Level& level : wrong_dof.Levels(kConfidence)) {
      EXPECT_FALSE(level.IsNominal()) << "no power, dof " << dof << ", nominal " << level.nominal;
    }
    RecordProperty("dof" + std::to_string(dof), std::to_string(right.Levels()[3].measured));
  }
}

TEST(Coverage, BadNumbersAreNotCovered) {
  Coverage coverage(3);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), -1.0}) coverage.Add(bad);
  EXPECT_EQ(coverage.n(), 3);
  for (const Coverage::Level& level : coverage.Levels()) EXPECT_EQ(level.num_covered, 0);
  EXPECT_TRUE(std::isnan(Coverage(3).Levels()[0].measured));
}

TEST(Coverage, MergedPartsEqualOnePass) {
  RandomStream rng({.seed = 1, .purpose = 81});
  Coverage whole(4), first(4), second(4);
  for (int i = 0; i < 1000; ++i) {
    const double statistic = ChiSquare(rng, 4);
    whole.Add(statistic);
    (i < 300 ? first : second).Add(statistic);
  }
  first.Merge(second);
  EXPECT_EQ(first.n(), 1000);
  for (size_t i = 0; i < whole.Levels().size(); ++i) {
    EXPECT_EQ(first.Levels()[i].num_covered, whole.Levels()[i].num_covered);
  }
  EXPECT_THROW(first.Merge(Coverage(5)), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
