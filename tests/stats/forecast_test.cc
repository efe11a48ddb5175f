#include "stats/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stats/moments.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/example_forecasts.h"

namespace rcme {
namespace {

TEST(Forecast, ScoresByHand) {
  EXPECT_DOUBLE_EQ(BrierScore(0.25, true), 0.5625);
  EXPECT_DOUBLE_EQ(BrierScore(0.25, false), 0.0625);
  EXPECT_DOUBLE_EQ(LogScore(0.25, true), std::log(4.0));
  EXPECT_DOUBLE_EQ(LogScore(0.25, false), std::log(4.0 / 3.0));
  EXPECT_DOUBLE_EQ(LogScore(0.0, true), -std::log(1e-4)) << "clipped";
  EXPECT_NEAR(LogScore(1.0, true), 1e-4, 1e-8);
  EXPECT_DOUBLE_EQ(LogScore(1.0, false, 0.01), std::log(100.0));
  EXPECT_NEAR(MeasureBrierScore(ExampleForecasts()).value, 0.188125, 1e-14)
      << "tests/known_answers/forecasts.py";
}

TEST(Forecast, ScoresAreProper) {
  for (const double right : {0.02, 0.3, 0.5, 0.9}) {
    for (int i = 0; i <= 100; ++i) {
      const double stated = i / 100.0;
      const auto expected = [&](double (*score)(double, bool), double p) {
        return right * score(p, true) + (1.0 - right) * score(p, false);
      };
      const auto log_score = [](double p, bool happened) { return LogScore(p, happened); };
      EXPECT_GE(expected(BrierScore, stated), expected(BrierScore, right));
      EXPECT_GE(expected(log_score, stated), expected(log_score, right));
    }
  }
}

// Right probabilities, uniform: E (p - y)^2 = E p (1 - p) = 1/6, and the mean entropy is 1/2 nat. 1,000
// repetitions of 300 forecasts: the intervals hold for any number of looks, and so miss at one look in less
// than 5 of 100. Forecasts of which 1/4 is added to the half of p score otherwise.
TEST(Forecast, IntervalsCoverClosedForms) {
  CoverageCount brier, log, brier_of_others;
  Moments values;
  RandomStream rng({.seed = 1, .purpose = 402});
  for (int repetition = 0; repetition < 1000; ++repetition) {
    const std::vector<Forecast> right = UniformForecasts(
        300, [](double p) { return p; }, rng);
    const std::vector<Forecast> others = UniformForecasts(
        300, [](double p) { return 0.25 + 0.5 * p; }, rng);
    brier.Add(MeasureBrierScore(right).interval.Contains(1.0 / 6.0));
    log.Add(MeasureLogScore(right).interval.Contains(0.5));
    brier_of_others.Add(MeasureBrierScore(others).interval.Contains(1.0 / 6.0));
    values.Add(MeasureBrierScore(right).value);
  }
  EXPECT_GT(brier.interval().lower, 0.95) << brier;
  EXPECT_GT(log.interval().lower, 0.95) << log;
  EXPECT_NEAR(values.mean(), 1.0 / 6.0, 4.0 * values.standard_error());
  EXPECT_LT(brier_of_others.rate(), 0.3) << "power: " << brier_of_others;
}

// Where failures are rare the squares are skewed: 0.3 % and 4 % of 300, right probabilities of two kinds of
// trials, 1,000 repetitions. Student's interval covers 0.75 and 0.92.
TEST(Forecast, IntervalsCoverWhereEventsAreRare) {
  const struct {
    double few, many, least_of_student, greatest_of_student;
  } kCases[] = {{0.001, 0.021, 0.5, 0.85}, {0.02, 0.22, 0.9, 0.95}};
  for (std::uint32_t c = 0; c < std::size(kCases); ++c) {
    const double few = kCases[c].few, many = kCases[c].many;
    const double truth = 0.9 * few * (1.0 - few) + 0.1 * many * (1.0 - many);
    CoverageCount brier, share, student;
    RandomStream rng({.seed = 1, .condition = c, .purpose = 403});
    for (int repetition = 0; repetition < 1000; ++repetition) {
      std::vector<Forecast> forecasts;
      std::vector<double> scores;
      for (int i = 0; i < 300; ++i) {
        const double p = i % 10 == 0 ? many : few;
        forecasts.push_back({p, rng.Uniform() < p, i});
        scores.push_back(BrierScore(p, forecasts.back().happened));
      }
      brier.Add(MeasureBrierScore(forecasts).interval.Contains(truth));
      share.Add(MeasureShareHappened(forecasts).interval.Contains(0.9 * few + 0.1 * many));
      student.Add(MeasureClusteredMean(scores, ListClusters(forecasts)).interval.Contains(truth));
    }
    EXPECT_GT(brier.interval().upper, 0.975) << brier;
    EXPECT_GT(share.interval().upper, 0.95) << share;
    EXPECT_GT(share.rate(), 0.94) << share;
    EXPECT_GT(student.rate(), kCases[c].least_of_student) << student;
    EXPECT_LT(student.rate(), kCases[c].greatest_of_student) << student;
  }
}

// Scenes of four equal trials: as if there were a quarter.
TEST(Forecast, IntervalsAreByClusters) {
  RandomStream rng({.seed = 1, .purpose = 405});
  const std::vector<Forecast> once = UniformForecasts(
      200, [](double p) { return p; }, rng);
  std::vector<Forecast> copies;
  for (const Forecast& forecast : once) copies.insert(copies.end(), 4, forecast);
  const ClusteredEstimate single = MeasureBrierScore(once), repeated = MeasureBrierScore(copies);
  EXPECT_NEAR(repeated.value, single.value, 1e-13);
  EXPECT_NEAR(repeated.standard_error, single.standard_error, 1e-13);
  EXPECT_NEAR(repeated.interval.lower, single.interval.lower, 1e-9);
  EXPECT_NEAR(repeated.interval.upper, single.interval.upper, 1e-9);
  EXPECT_EQ(repeated.n, 800);
  const ClusteredEstimate share = MeasureShareHappened(copies);
  EXPECT_GT(share.interval.upper - share.interval.lower,
            1.0 * (MeasureShareHappened(once).interval.upper - MeasureShareHappened(once).interval.lower));
}

TEST(Forecast, OutcomesAreDrawnFromTheProbabilitiesAndTogetherWithinACluster) {
  std::vector<Forecast> forecasts = {
      {0.3, false, 7}, {0.6, false, 7}, {0.3, false, -2}, {0.0, false, 9}, {1.0, false, 9}};
  const std::vector<std::int64_t> clusters = NumberedClusters(forecasts);
  EXPECT_EQ(clusters, (std::vector<std::int64_t>{0, 0, 1, 2, 2}));
  RandomStream rng({.seed = 1, .purpose = 404});
  CoverageCount first, second, apart, both_apart;
  for (int repetition = 0; repetition < 10'000; ++repetition) {
    const std::vector<bool> y = DrawOutcomes(forecasts, clusters, rng);
    EXPECT_TRUE(!y[0] || y[1]) << "one number decides of the whole cluster";
    EXPECT_FALSE(y[3]);
    EXPECT_TRUE(y[4]);
    first.Add(y[0]), second.Add(y[1]), apart.Add(y[2]), both_apart.Add(y[0] && y[2]);
  }
  EXPECT_TRUE(first.Admits(0.3)) << first;
  EXPECT_TRUE(second.Admits(0.6)) << second;
  EXPECT_TRUE(apart.Admits(0.3)) << apart;
  EXPECT_TRUE(both_apart.Admits(0.09)) << both_apart;
}

TEST(Forecast, BadInput) {
  EXPECT_THROW(MeasureBrierScore({}), std::invalid_argument);
  for (const double bad : {-0.01, 1.01, std::nan("")}) {
    EXPECT_THROW(MeasureLogScore(std::vector<Forecast>{{bad, true, 0}}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace rcme
