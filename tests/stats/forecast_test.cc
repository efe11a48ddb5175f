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

// Right probabilities, uniform: E (p - y)^2 = E p (1 - p) = 1/6, and the mean entropy is 1/2 nat. 2,000
// repetitions of 300 forecasts. Forecasts that are always twice as far from 1/2 score otherwise.
TEST(Forecast, IntervalsCoverClosedForms) {
  CoverageCount brier, log, brier_of_sharper;
  RandomStream rng({.seed = 1, .purpose = 402});
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const std::vector<Forecast> right = UniformForecasts(
        300, [](double p) { return p; }, rng);
    const std::vector<Forecast> sharper = UniformForecasts(
        300, [](double p) { return 0.25 + 0.5 * p; }, rng);
    brier.Add(MeasureBrierScore(right).interval.Contains(1.0 / 6.0));
    log.Add(MeasureLogScore(right).interval.Contains(0.5));
    brier_of_sharper.Add(MeasureBrierScore(sharper).interval.Contains(1.0 / 6.0));
  }
  EXPECT_TRUE(brier.Admits(0.95)) << brier;
  EXPECT_TRUE(log.Admits(0.95)) << log;
  EXPECT_LT(brier_of_sharper.rate(), 0.05) << "power: " << brier_of_sharper;
}

// Where failures are rare the squares are skewed and Student's interval covers less: 4 % of 300, right
// probabilities (two kinds of trials, p = .02 and p = .22).
TEST(Forecast, IntervalCoversLessWhereEventsAreRare) {
  CoverageCount covered;
  RandomStream rng({.seed = 1, .purpose = 403});
  for (int repetition = 0; repetition < 2000; ++repetition) {
    std::vector<Forecast> forecasts;
    for (int i = 0; i < 300; ++i) {
      const double p = i % 10 == 0 ? 0.22 : 0.02;
      forecasts.push_back({p, rng.Uniform() < p, i});
    }
    covered.Add(MeasureBrierScore(forecasts).interval.Contains(0.9 * 0.02 * 0.98 + 0.1 * 0.22 * 0.78));
  }
  EXPECT_GT(covered.rate(), 0.9) << covered;
  EXPECT_LT(covered.rate(), 0.955) << covered;
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
