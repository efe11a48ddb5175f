#include "simulator/outlier_model.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/tilted_binomial.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

OutlierModel Model(const char* ratio, const char* count, const char* tilted_to) {
  OutlierModel outliers;
  FindParameter(Parameters(outliers), "outlier_ratio").SetFromText(ratio);
  FindParameter(Parameters(outliers), "outlier_count").SetFromText(count);
  FindParameter(Parameters(outliers), "tilted_to").SetFromText(tilted_to);
  return outliers;
}

// Chi-square of 40,000 numbers of wrong matches out of 20 against a law, over the numbers whose expected
// count is at least 10: the statistic over its 1 - 1e-4 quantile.
template <typename Law>
double RelativeChiSquare(const OutlierModel& outliers, Law law, std::uint32_t purpose) {
  constexpr int kDraws = 40'000;
  std::vector<int> counts(21);
  RandomStream rng({.seed = 1, .purpose = purpose});
  for (int i = 0; i < kDraws; ++i) ++counts[static_cast<size_t>(outliers.DrawCount(20, rng).num_outliers)];
  double sum = 0.0;
  int num_cells = 0;
  for (int k = 0; k <= 20; ++k) {
    const double expected = kDraws * law(k);
    if (expected < 10.0) continue;
    sum += std::pow(counts[static_cast<size_t>(k)] - expected, 2.0) / expected;
    ++num_cells;
  }
  return sum / ChiSquareQuantile(num_cells - 1, 1.0 - 1e-4);
}

double Binomial(int k, double p) {
  return boost::math::pdf(boost::math::binomial(20, p), static_cast<double>(k));
}
double Mixture(int k, double p, double q) {
  return std::abs(boost::math::ibeta(k + 1.0, 21.0 - k, q) - boost::math::ibeta(k + 1.0, 21.0 - k, p)) /
         (21.0 * std::abs(q - p));
}

TEST(OutlierModel, ABernoulliCountIsBinomial) {
  const OutlierModel outliers = Model("0.3", "bernoulli", "none");
  EXPECT_LT(RelativeChiSquare(
                outliers, [](int k) { return Binomial(k, 0.3); }, 90),
            1.0);
  EXPECT_GT(RelativeChiSquare(
                outliers, [](int k) { return Binomial(k, 0.32); }, 90),
            2.0)
      << "no power";
  RandomStream rng({.seed = 1, .purpose = 91});
  EXPECT_EQ(outliers.DrawCount(20, rng).weight, 1.0);
}

TEST(OutlierModel, ATiltedCountIsTheMixtureOfBinomials) {
  const OutlierModel up = Model("0.3", "bernoulli", "0.8"), down = Model("0.7", "bernoulli", "0.1");
  EXPECT_LT(RelativeChiSquare(
                up, [](int k) { return Mixture(k, 0.3, 0.8); }, 92),
            1.0);
  EXPECT_GT(RelativeChiSquare(
                up, [](int k) { return Mixture(k, 0.3, 0.83); }, 92),
            2.0)
      << "no power";
  EXPECT_LT(RelativeChiSquare(
                down, [](int k) { return Mixture(k, 0.1, 0.7); }, 93),
            1.0);
}

// The weight of every trial is that of its number; weighted, the mean number is that of the untilted law
// (z-test at 1e-4).
TEST(OutlierModel, WeightsMakeUpForTheTilt) {
  const OutlierModel outliers = Model("0.3", "bernoulli", "0.6");
  RandomStream rng({.seed = 1, .purpose = 94});
  Moments weighted, unweighted;
  for (int i = 0; i < 40'000; ++i) {
    const OutlierModel::Drawn drawn = outliers.DrawCount(20, rng);
    ASSERT_EQ(drawn.weight, TiltedBinomialWeight(drawn.num_outliers, 20, 0.3, 0.6));
    weighted.Add(drawn.weight * drawn.num_outliers);
    unweighted.Add(drawn.num_outliers);
  }
  EXPECT_LT(std::abs(weighted.mean() - 6.0), 3.89 * weighted.standard_error());
  EXPECT_GT(std::abs(unweighted.mean() - 6.0), 10.0 * unweighted.standard_error()) << "no power";
}

TEST(OutlierModel, TheEnds) {
  RandomStream rng({.seed = 1, .purpose = 95});
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(Model("0.3", "bernoulli", "0.3").DrawCount(20, rng).weight, 1.0);  // not tilted
    const OutlierModel::Drawn from_none = Model("0", "bernoulli", "0.5").DrawCount(20, rng);
    EXPECT_EQ(from_none.weight > 0.0, from_none.num_outliers == 0);
    EXPECT_EQ(Model("0", "bernoulli", "none").DrawCount(20, rng).num_outliers, 0);
    EXPECT_EQ(Model("1", "bernoulli", "none").DrawCount(20, rng).num_outliers, 20);
  }
}

TEST(OutlierModel, AnExactCountCannotBeTilted) {
  RandomStream rng({.seed = 1, .purpose = 96});
  EXPECT_TRUE(ThrowsInputError([&] { Model("0.3", "exact", "0.5").DrawCount(20, rng); },
                               {"tilted_to: 0.5", "outlier_count"}));
}

}  // namespace
}  // namespace rcme
