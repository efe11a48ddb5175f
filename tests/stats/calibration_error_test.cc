// Known answers in fractions:  /usr/bin/python3 tests/known_answers/forecasts.py
#include "stats/calibration_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/example_forecasts.h"

namespace rcme {
namespace {

double ComputeExampleError(Binning binning, int num_bins) {
  return ExpectedCalibrationError(BinForecasts(ExampleForecasts(), binning, num_bins));
}

TEST(CalibrationError, KnownAnswers) {
  EXPECT_NEAR(ComputeExampleError(Binning::kEqualWidth, 4), 0.10625, 1e-12);
  EXPECT_NEAR(ComputeExampleError(Binning::kEqualMass, 4), 0.10625, 1e-12);
  EXPECT_NEAR(ComputeExampleError(Binning::kEqualWidth, 10), 0.20625, 1e-12);
  EXPECT_NEAR(ComputeExampleError(Binning::kEqualMass, 10), 0.18125, 1e-12);
  RandomStream rng({.seed = 1, .purpose = 420});
  EXPECT_NEAR(MeasureCalibrationError(ExampleForecasts(), Binning::kEqualMass, 10, 1, rng).value, 0.18125,
              1e-12);
}

TEST(CalibrationError, BinsByHand) {
  const std::vector<CalibrationBin> bins = BinForecasts(ExampleForecasts(), Binning::kEqualWidth, 2);
  ASSERT_EQ(bins.size(), 2U);
  EXPECT_EQ(bins[0].n, 8);
  EXPECT_EQ(bins[0].num_happened, 2);
  EXPECT_EQ(bins[0].least, 0.0);
  EXPECT_EQ(bins[0].greatest, 0.4);
  EXPECT_NEAR(bins[0].mean_probability, 1.7 / 8.0, 1e-15);
  EXPECT_EQ(bins[0].interval.upper, ExactBinomialInterval(2, 8).upper);
  EXPECT_EQ(bins[1].least, 0.5);
  EXPECT_EQ(bins[1].greatest, 1.0) << "1 is of the last bin";
  // Equal probabilities stay together: of 10 forecasts, nine of them 0, two bins are filled, not five.
  std::vector<Forecast> ties(9, Forecast{0.0, false, 0});
  ties.push_back({0.5, true, 1});
  EXPECT_EQ(BinForecasts(ties, Binning::kEqualMass, 5).size(), 2U);
}

// Uniform p of events that happen with probability p^2: the limit is the mean of p - p^2, 1/6, whatever the
// bins, as the distance has one sign.
TEST(CalibrationError, HasItsLimit) {
  RandomStream rng({.seed = 1, .purpose = 421});
  Moments width, mass;
  for (int repetition = 0; repetition < 50; ++repetition) {
    const std::vector<Forecast> forecasts = UniformForecasts(
        2000, [](double p) { return p * p; }, rng);
    width.Add(ExpectedCalibrationError(BinForecasts(forecasts, Binning::kEqualWidth, 10)));
    mass.Add(ExpectedCalibrationError(BinForecasts(forecasts, Binning::kEqualMass, 10)));
  }
  EXPECT_NEAR(width.mean(), 1.0 / 6.0, 4.0 * width.standard_error() + 0.002);
  EXPECT_NEAR(mass.mean(), 1.0 / 6.0, 4.0 * mass.standard_error() + 0.002);
  EXPECT_LT(width.standard_error(), 0.002);
}

// Right probabilities, 2,000 repetitions: the p-value is at most 0.05 in 5 of 100, the error above its 95 %
// quantile in about as many (0.04 to 0.07, as that quantile is of 99 samples), and the mean the one that is
// said.
TEST(CalibrationError, ComesWithWhatChanceGives) {
  RandomStream rng({.seed = 1, .purpose = 422});
  CoverageCount alarms, above, caught;
  Moments difference;
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const std::vector<Forecast> right = UniformForecasts(
        200, [](double p) { return p; }, rng);
    const MeasuredCalibrationError error = MeasureCalibrationError(right, Binning::kEqualMass, 10, 99, rng);
    alarms.Add(error.p_value <= 0.05);
    above.Add(error.value > error.upper_if_calibrated);
    difference.Add(error.value - error.mean_if_calibrated);
    if (repetition >= 300) continue;
    const std::vector<Forecast> wrong = UniformForecasts(
        200, [](double p) { return 0.25 + 0.5 * p; }, rng);
    caught.Add(MeasureCalibrationError(wrong, Binning::kEqualMass, 10, 99, rng).p_value <= 0.05);
  }
  EXPECT_TRUE(alarms.Admits(0.05)) << alarms;
  EXPECT_FALSE(alarms.Admits(0.08)) << "no power";
  EXPECT_TRUE(above.Admits(0.05)) << above;
  EXPECT_NEAR(difference.mean(), 0.0, 4.0 * difference.standard_error());
  EXPECT_GT(caught.interval().lower, 0.85) << caught;
}

TEST(CalibrationError, BadInput) {
  RandomStream rng({.seed = 1, .purpose = 423});
  EXPECT_THROW(BinForecasts({}, Binning::kEqualMass, 10), std::invalid_argument);
  EXPECT_THROW(BinForecasts(ExampleForecasts(), Binning::kEqualMass, 0), std::invalid_argument);
  EXPECT_THROW(MeasureCalibrationError(ExampleForecasts(), Binning::kEqualWidth, 10, 0, rng),
               std::invalid_argument);
}

// 30 conditions of 20 forecasts each, whose log odds are wrong by an amount of their own, one on average:
// what the interval has to hold is the error of a million such forecasts. 300 repetitions.
TEST(CalibrationError, IntervalForThePopulationOfConditions) {
  RandomStream rng({.seed = 1, .purpose = 489});
  const auto forecasts_of = [&](int num_conditions, int num_trials) {
    std::vector<Forecast> forecasts;
    for (int condition = 0; condition < num_conditions; ++condition) {
      const double error = 1.0 + rng.Normal(), level = rng.Normal();
      for (int i = 0; i < num_trials; ++i) {
        const double log_odds = level + rng.Normal();
        const double right = 1.0 / (1.0 + std::exp(-log_odds - error));
        forecasts.push_back({1.0 / (1.0 + std::exp(-log_odds)), rng.Uniform() < right, condition});
      }
    }
    return forecasts;
  };
  const double truth =
      ExpectedCalibrationError(BinForecasts(forecasts_of(200'000, 5), Binning::kEqualWidth, 10));
  CoverageCount covered;
  for (int repetition = 0; repetition < 300; ++repetition) {
    const std::vector<Forecast> forecasts = forecasts_of(30, 20);
    RandomStream samples({.seed = 1, .trial = static_cast<std::uint32_t>(repetition), .purpose = 490});
    const BootstrapEstimate error =
        MeasurePopulationCalibrationError(forecasts, Binning::kEqualWidth, 10, {.num_samples = 200}, samples);
    EXPECT_NEAR(error.value, ExpectedCalibrationError(BinForecasts(forecasts, Binning::kEqualWidth, 10)),
                1e-12);
    covered.Add(error.interval.Contains(truth));
  }
  EXPECT_TRUE(covered.Admits(0.95)) << covered;
  EXPECT_FALSE(covered.Admits(0.84)) << "no power";
}

// 30 conditions of four forecasts without an event: the rate may be up to 0.12 (one trial a condition
// counts), so that probabilities of 0.002 may be right, or wrong by as much.
TEST(CalibrationError, EventsThatWereNotSeenAreAllowedFor) {
  std::vector<Forecast> forecasts;
  for (int condition = 0; condition < 30; ++condition)
    forecasts.insert(forecasts.end(), 4, {0.001 * (condition % 4), false, condition});
  RandomStream rng({.seed = 1, .purpose = 491});
  const BootstrapEstimate error =
      MeasurePopulationCalibrationError(forecasts, Binning::kEqualWidth, 10, {}, rng);
  EXPECT_EQ(error.interval.lower, 0.0);
  EXPECT_GT(error.interval.upper, 0.1);
  // Probabilities of 0.9 are wrong all the same.
  for (Forecast& forecast : forecasts) forecast.probability = 0.9;
  EXPECT_GT(MeasurePopulationCalibrationError(forecasts, Binning::kEqualWidth, 10, {}, rng).interval.lower,
            0.7);
}

}  // namespace
}  // namespace rcme
