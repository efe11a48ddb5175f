// Known answers in fractions:  /usr/bin/python3 tests/known_answers/forecasts.py
#include "stats/reliability.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "tests/test_support/coverage_count.h"
#include "tests/test_support/example_forecasts.h"

namespace rcme {
namespace {

double Right(double p) { return p; }
double Squared(double p) { return p * p; }

TEST(Reliability, KnownAnswers) {
  const BrierDecomposition parts = DecomposeBrierScore(ExampleForecasts());
  EXPECT_NEAR(parts.brier, 0.188125, 1e-14);
  EXPECT_NEAR(parts.miscalibration, 0.036339285714, 1e-12);
  EXPECT_NEAR(parts.discrimination, 0.098214285714, 1e-12);
  EXPECT_NEAR(parts.uncertainty, 0.25, 1e-14);
  const std::vector<ReliabilityStep> curve = ReliabilityCurve(ExampleForecasts());
  const ReliabilityStep kExpected[] = {
      {0.0, 0.0, 0.0, 1, 0}, {0.1, 0.4, 2.0 / 7.0, 7, 2}, {0.5, 0.7, 0.5, 4, 2}, {0.8, 1.0, 1.0, 4, 4}};
  ASSERT_EQ(curve.size(), std::size(kExpected));
  for (size_t i = 0; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i].first, kExpected[i].first);
    EXPECT_EQ(curve[i].last, kExpected[i].last);
    EXPECT_NEAR(curve[i].recalibrated, kExpected[i].recalibrated, 1e-14);
    EXPECT_EQ(curve[i].n, kExpected[i].n);
    EXPECT_EQ(curve[i].num_happened, kExpected[i].num_happened);
  }
}

// Uniform p of events that happen with probability q = p^2: the miscalibration is E (p - q)^2 = 1/30, the
// discrimination Var q = 4/45, the uncertainty 2/9. Over 20 samples of 5,000 each is known to about 1 %; the
// fit of the curve adds some 1e-4.
TEST(Reliability, PartsHaveTheirLimits) {
  RandomStream rng({.seed = 1, .purpose = 410});
  BrierDecomposition mean;
  for (int repetition = 0; repetition < 20; ++repetition) {
    const BrierDecomposition parts = DecomposeBrierScore(UniformForecasts(5000, Squared, rng));
    EXPECT_NEAR(parts.brier, parts.miscalibration - parts.discrimination + parts.uncertainty, 1e-13);
    EXPECT_GE(parts.miscalibration, 0.0);
    EXPECT_GE(parts.discrimination, 0.0);
    mean.miscalibration += parts.miscalibration / 20.0;
    mean.discrimination += parts.discrimination / 20.0;
    mean.uncertainty += parts.uncertainty / 20.0;
  }
  EXPECT_NEAR(mean.miscalibration, 1.0 / 30.0, 0.0015);
  EXPECT_NEAR(mean.discrimination, 4.0 / 45.0, 0.003);
  EXPECT_NEAR(mean.uncertainty, 2.0 / 9.0, 0.002);
}

TEST(Reliability, ForecastsOfOneNumberHaveNoDiscrimination) {
  std::vector<Forecast> same;
  for (int i = 0; i < 10; ++i) same.push_back({0.5, i < 2, i});
  const BrierDecomposition parts = DecomposeBrierScore(same);
  EXPECT_NEAR(parts.discrimination, 0.0, 1e-15);
  EXPECT_NEAR(parts.miscalibration, 0.09, 1e-15);
  EXPECT_NEAR(parts.uncertainty, 0.16, 1e-15);
}

// 2,000 repetitions of 100 forecasts, 99 samples each: the p-value is at most 0.05 in exactly 5 of 100 of
// them where the probabilities are right, and the pointwise band is left at p = 0.5 in about as many (no more
// than 5 of 100, less by ties).
TEST(Reliability, FalseAlarmRateIsTheNominalOne) {
  CoverageCount alarms, outside;
  RandomStream rng({.seed = 1, .purpose = 411});
  for (int repetition = 0; repetition < 2000; ++repetition) {
    const std::vector<Forecast> right = UniformForecasts(100, Right, rng);
    const std::vector<double> at = {-0.5, 0.5, 1.5};
    const CalibrationCheck check = CheckCalibration(right, at, 99, rng);
    alarms.Add(check.p_value <= 0.05);
    ASSERT_EQ(check.band.size(), 1U) << "only where there are forecasts";
    double curve = 0.0;  // at 0.5, by lines between the steps
    const std::vector<ReliabilityStep> steps = ReliabilityCurve(right);
    for (size_t i = 0; i < steps.size(); ++i) {
      if (steps[i].first <= 0.5) curve = steps[i].recalibrated;
      if (i > 0 && steps[i - 1].last < 0.5 && steps[i].first > 0.5) {
        const double share = (0.5 - steps[i - 1].last) / (steps[i].first - steps[i - 1].last);
        curve = steps[i - 1].recalibrated + share * (steps[i].recalibrated - steps[i - 1].recalibrated);
      }
    }
    outside.Add(curve < check.band[0].lower || curve > check.band[0].upper);
  }
  EXPECT_TRUE(alarms.Admits(0.05)) << alarms;
  EXPECT_FALSE(alarms.Admits(0.08)) << "no power";
  EXPECT_LT(outside.interval().lower, 0.05) << outside;
  EXPECT_GT(outside.interval().upper, 0.03) << outside;
}

// Of events that happen with probability p^2, 100 forecasts are enough in nine of ten samples.
TEST(Reliability, FindsWrongProbabilities) {
  CoverageCount caught;
  RandomStream rng({.seed = 1, .purpose = 412});
  for (int repetition = 0; repetition < 300; ++repetition)
    caught.Add(CheckCalibration(UniformForecasts(100, Squared, rng), {}, 99, rng).p_value <= 0.05);
  EXPECT_GT(caught.interval().lower, 0.85) << caught;
}

// Scenes of four trials that happen all or none: with each for itself the alarms are false in far more than 5
// of 100; by scenes they keep to it.
TEST(Reliability, ClustersAreNotTakenForIndependent) {
  CoverageCount by_scene, as_independent;
  RandomStream rng({.seed = 1, .purpose = 413});
  for (int repetition = 0; repetition < 500; ++repetition) {
    std::vector<Forecast> forecasts;
    for (int scene = 0; scene < 25; ++scene) {
      const double p = rng.Uniform();
      const bool happened = rng.Uniform() < p;
      for (int i = 0; i < 4; ++i) forecasts.push_back({p, happened, scene});
    }
    by_scene.Add(CheckCalibration(forecasts, {}, 99, rng).p_value <= 0.05);
    for (size_t i = 0; i < forecasts.size(); ++i) forecasts[i].cluster = static_cast<std::int64_t>(i);
    as_independent.Add(CheckCalibration(forecasts, {}, 99, rng).p_value <= 0.05);
  }
  EXPECT_TRUE(by_scene.Admits(0.05)) << by_scene;
  EXPECT_GT(as_independent.rate(), 0.2) << as_independent;
}

// As an exact test has it: never 0, by whatever many samples.
TEST(Reliability, PValueOfTheWorstForecasts) {
  std::vector<Forecast> wrong;
  for (int i = 0; i < 50; ++i) wrong.push_back({i % 2 == 0 ? 0.01 : 0.99, i % 2 == 0, i});
  RandomStream rng({.seed = 1, .purpose = 415});
  EXPECT_EQ(CheckCalibration(wrong, {}, 9, rng).p_value, 0.1);
}

TEST(Reliability, BadInput) {
  RandomStream rng({.seed = 1, .purpose = 414});
  EXPECT_THROW(ReliabilityCurve({}), std::invalid_argument);
  EXPECT_THROW(CheckCalibration(ExampleForecasts(), {}, 0, rng), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
