// Known answers by the max-min formula, in fractions:  /usr/bin/python3 tests/known_answers/forecasts.py
#include "stats/isotonic_regression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

TEST(IsotonicRegression, KnownAnswer) {
  const std::vector<double> values = {3, 1, 2, 6, 5, 4, 7, 7, 1}, weights = {1, 2, 1, 1, 3, 1, 1, 1, 2};
  const std::vector<double> fitted = PoolAdjacentViolators(values, weights);
  const double c = 41.0 / 9.0, kExpected[] = {5.0 / 3.0, 5.0 / 3.0, 2.0, c, c, c, c, c, c};
  ASSERT_EQ(fitted.size(), std::size(kExpected));
  for (size_t i = 0; i < fitted.size(); ++i) EXPECT_NEAR(fitted[i], kExpected[i], 1e-14) << i;
}

// y_k = max over i <= k of min over j >= k of the mean of i..j: another way to the same, without pooling.
TEST(IsotonicRegression, AgreesWithTheMaxMinFormula) {
  RandomStream rng({.seed = 1, .purpose = 405});
  for (int repetition = 0; repetition < 200; ++repetition) {
    const size_t n = 1 + rng.IntegerBelow(12);
    std::vector<double> values(n), weights(n);
    for (double& value : values) value = rng.IntegerBelow(6);
    for (double& weight : weights) weight = 0.5 + rng.IntegerBelow(4);
    const std::vector<double> fitted = PoolAdjacentViolators(values, weights);
    for (size_t k = 0; k < n; ++k) {
      double greatest = -1e9;
      for (size_t i = 0; i <= k; ++i) {
        double least = 1e9, sum = 0.0, weight = 0.0;
        for (size_t j = i; j < n; ++j) {
          sum += weights[j] * values[j], weight += weights[j];
          if (j >= k) least = std::min(least, sum / weight);
        }
        greatest = std::max(greatest, least);
      }
      EXPECT_NEAR(fitted[k], greatest, 1e-12);
    }
  }
}

TEST(IsotonicRegression, EqualPlacesAreOnePointAndLinesJoinPoints) {
  const IsotonicFit fit = FitIsotonic(std::vector<double>{2, 1, 2, 4, 3}, std::vector<double>{1, 0, 2, 5, 1});
  EXPECT_EQ(fit.x, (std::vector<double>{1, 2, 3, 4}));
  ASSERT_EQ(fit.y.size(), 4U);
  EXPECT_NEAR(fit.y[1], 4.0 / 3.0, 1e-15) << "two at 2, one at 3, pooled";
  EXPECT_NEAR(fit.y[2], 4.0 / 3.0, 1e-15);
  EXPECT_EQ(fit.At(-kInfinity), 0.0);
  EXPECT_NEAR(fit.At(1.25), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(fit.At(2.5), 4.0 / 3.0, 1e-15);
  EXPECT_EQ(fit.At(4.0), 5.0);
  EXPECT_EQ(fit.At(9.0), 5.0);
  const IsotonicFit infinite =
      FitIsotonic(std::vector<double>{-kInfinity, 1, kInfinity}, std::vector<double>{0, 1, 2});
  EXPECT_EQ(infinite.At(-kInfinity), 0.0);
  EXPECT_EQ(infinite.At(5.0), 1.0);
  EXPECT_EQ(infinite.At(-5.0), 0.0);
  EXPECT_EQ(infinite.At(kInfinity), 2.0);
}

// The mean squared error of the fit to a line falls as n^(-2/3) (Zhang 2002): from n = 200 to 12,800, 64
// times as many, to a sixteenth.
TEST(IsotonicRegression, FindsARisingCurve) {
  RandomStream rng({.seed = 1, .purpose = 406});
  const auto error_of = [&](int n) {
    double error = 0.0;
    for (int repetition = 0; repetition < 20; ++repetition) {
      std::vector<double> x, y;
      for (int i = 0; i < n; ++i) {
        x.push_back(rng.Uniform());
        y.push_back(rng.Uniform() < x.back() ? 1.0 : 0.0);
      }
      const IsotonicFit fit = FitIsotonic(x, y);
      for (size_t i = 0; i < fit.x.size(); ++i)
        error += std::pow(fit.y[i] - fit.x[i], 2.0) / static_cast<double>(20 * fit.x.size());
    }
    return error;
  };
  const double ratio = error_of(200) / error_of(12'800);
  EXPECT_GT(ratio, 10.0);
  EXPECT_LT(ratio, 25.0);
}

TEST(IsotonicRegression, BadInput) {
  EXPECT_THROW(FitIsotonic({}, {}), std::invalid_argument);
  EXPECT_THROW(FitIsotonic(std::vector<double>{1.0}, {}), std::invalid_argument);
  EXPECT_THROW(FitIsotonic(std::vector<double>{std::nan("")}, std::vector<double>{1.0}),
               std::invalid_argument);
  EXPECT_THROW(PoolAdjacentViolators(std::vector<double>{1.0}, std::vector<double>{0.0}),
               std::invalid_argument);
  EXPECT_THROW(IsotonicFit().At(1.0), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
