// Known answers by scipy's minimizer and matrices:  /usr/bin/python3 tests/known_answers/forecasts.py
#include "stats/calibration_line.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/example_forecasts.h"

namespace rcme {
namespace {

TEST(CalibrationLine, KnownAnswers) {
  const CalibrationLine line = FitCalibrationLine(ExampleForecasts());
  EXPECT_NEAR(line.intercept.value, 0.0697630782, 1e-9);
  EXPECT_NEAR(line.intercept.standard_error, 0.4135455967, 1e-9);
  EXPECT_NEAR(line.slope.value, 0.6582243396, 1e-9);
  EXPECT_NEAR(line.slope.standard_error, 0.3529987099, 1e-9);
  EXPECT_EQ(line.slope.num_clusters, 9);
}

// logit q = -0.3 + 0.7 logit p, 2,000 repetitions of 400 forecasts: both intervals cover, and the standard
// errors are the spread to 6 % (which is known to 1.6 %).
TEST(CalibrationLine, CoversTheTrueLine) {
  RandomStream rng({.seed = 1, .purpose = 430});
  CoverageCount intercept, slope, slope_of_one;
  Moments slopes, standard_errors;
  const auto happens = [](double p) { return 1.0 / (1.0 + std::exp(0.3 - 0.7 * std::log(p / (1.0 - p)))); };
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const CalibrationLine line = FitCalibrationLine(UniformForecasts(400, happens, rng));
    ASSERT_TRUE(std::isfinite(line.slope.value));
    intercept.Add(line.intercept.interval.Contains(-0.3));
    slope.Add(line.slope.interval.Contains(0.7));
    slope_of_one.Add(line.slope.interval.Contains(1.0));
    slopes.Add(line.slope.value);
    standard_errors.Add(line.slope.standard_error);
  }
  EXPECT_TRUE(intercept.Admits(0.95)) << intercept;
  EXPECT_TRUE(slope.Admits(0.95)) << slope;
  EXPECT_LT(slope_of_one.rate(), 0.25) << "power: " << slope_of_one;
  const double spread = std::sqrt(slopes.variance());
  EXPECT_NEAR(standard_errors.mean(), spread, 0.06 * spread);
}

// Each forecast four times, with its outcome, as one scene: nothing is learnt, so the standard error stays.
TEST(CalibrationLine, CopiesInAClusterAddNothing) {
  RandomStream rng({.seed = 1, .purpose = 431});
  const std::vector<Forecast> once = UniformForecasts(
      300, [](double p) { return p; }, rng);
  std::vector<Forecast> copies;
  for (const Forecast& forecast : once) copies.insert(copies.end(), 4, forecast);
  const CalibrationLine single = FitCalibrationLine(once), repeated = FitCalibrationLine(copies);
  EXPECT_NEAR(repeated.slope.value, single.slope.value, 1e-8);
  EXPECT_NEAR(repeated.slope.standard_error, single.slope.standard_error, 1e-8);
  EXPECT_NEAR(repeated.intercept.standard_error, single.intercept.standard_error, 1e-8);
}

TEST(CalibrationLine, WithoutAnOptimumNothingIsClaimed) {
  std::vector<Forecast> apart, one_kind, one_number;
  for (int i = 0; i < 20; ++i) {
    apart.push_back({(i + 0.5) / 20.0, i >= 10, i});
    one_kind.push_back({(i + 0.5) / 20.0, false, i});
    one_number.push_back({0.3, i % 3 == 0, i});
  }
  for (const std::vector<Forecast>& forecasts : {apart, one_kind, one_number}) {
    const CalibrationLine line = FitCalibrationLine(forecasts);
    EXPECT_TRUE(std::isnan(line.slope.value) && std::isnan(line.intercept.standard_error));
    EXPECT_TRUE(line.slope.interval.Contains(1e9));
  }
  // By rounding, the matrix of forecasts that are all equal is not always exactly singular.
  for (int percent = 1; percent < 100; ++percent) {
    for (const int n : {7, 30, 111}) {
      std::vector<Forecast> equal;
      for (int i = 0; i < n; ++i) equal.push_back({percent / 100.0, i % 3 == 0, i});
      EXPECT_TRUE(std::isnan(FitCalibrationLine(equal).slope.value)) << percent << " % of " << n;
    }
  }
  EXPECT_THROW(FitCalibrationLine({}), std::invalid_argument);
}

// Far from the start, where Newton's whole steps overshoot: the optimum is where the gradient is 0.
TEST(CalibrationLine, ConvergesFromAfar) {
  RandomStream rng({.seed = 1, .purpose = 432});
  for (const double slope : {-1.0, 0.0, 0.2, 3.0}) {
    const auto happens = [&](double p) {
      return 1.0 / (1.0 + std::exp(2.0 - slope * std::log(p / (1.0 - p))));
    };
    const CalibrationLine line = FitCalibrationLine(UniformForecasts(2000, happens, rng));
    ASSERT_TRUE(std::isfinite(line.slope.value)) << slope;
    EXPECT_NEAR(line.slope.value, slope, 4.5 * line.slope.standard_error);
    EXPECT_NEAR(line.intercept.value, -2.0, 4.5 * line.intercept.standard_error);
    EXPECT_LT(line.slope.standard_error, 0.3);
  }
}

}  // namespace
}  // namespace rcme
