#include "stats/level_crossing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/constants.h"
#include "tests/test_support/known_crossings.h"

namespace rcme {
namespace {

TEST(CrossingInterval, LiesBetweenLevelsThatArePlainlyBelowAndAbove) {
  const std::vector<EventsAtLevel> events = {{0.2, 0, 1000}, {0.3, 500, 1000}, {0.7, 1000, 1000}};
  const Interval interval = FindCrossingInterval(events, 0.5);
  EXPECT_EQ(interval.lower, 0.2);
  EXPECT_EQ(interval.upper, 0.7);
}

TEST(CrossingInterval, IsOpenWhereTheCrossingMayLieBeyond) {
  const std::vector<EventsAtLevel> below = {{0.2, 0, 1000}, {0.7, 1, 1000}};
  EXPECT_EQ(FindCrossingInterval(below, 0.5).lower, 0.7);
  EXPECT_EQ(FindCrossingInterval(below, 0.5).upper, kInfinity);
  const std::vector<EventsAtLevel> above = {{0.2, 999, 1000}, {0.7, 1000, 1000}};
  EXPECT_EQ(FindCrossingInterval(above, 0.5).lower, -kInfinity);
  EXPECT_EQ(FindCrossingInterval(above, 0.5).upper, 0.2);
}

// A rate that falls from 1 to 0 has no such crossing.
TEST(CrossingInterval, IsEverythingWhereTheNumbersContradictARisingRate) {
  const std::vector<EventsAtLevel> events = {{0.2, 1000, 1000}, {0.7, 0, 1000}};
  EXPECT_EQ(FindCrossingInterval(events, 0.5).lower, -kInfinity);
  EXPECT_EQ(FindCrossingInterval(events, 0.5).upper, kInfinity);
}

// Symmetric counts about one half: the crossing of 1/2 is in the middle, and the interval symmetric. Its half
// width: with log-odds +-1 at +-.25 (731 of 1000), the standard error of the crossing is sqrt(var(a)) / b =
// sqrt(1 / (2 * 1000 * .731 * .269)) / 4 = .01261, times 1.96.
TEST(LogisticInterval, KnownAnswer) {
  const std::vector<EventsAtLevel> events = {{0.25, 269, 1000}, {0.75, 731, 1000}};
  const Interval interval = FindLogisticInterval(events, 0.5);
  EXPECT_NEAR(0.5 * (interval.lower + interval.upper), 0.5, 1e-6);
  EXPECT_NEAR(0.5 * (interval.upper - interval.lower), 0.02472, 0.0002);
}

// A setting of ten whole numbers whose rate rises by a step after the sixth. 200 searches with an exact
// guarantee of .95 each; fewer than 178 hold with a probability of 3e-4. The fresh trials are at four numbers
// or more, so that 3,000 tell on which side of the step each is.
TEST(FindCrossing, OfFewPlacesIsBetweenTwoOfThem) {
  const auto place_of_run = [](double x) { return std::round(9.0 * x) / 9.0; };
  int num_covered = 0, num_bracketed = 0;
  for (std::uint32_t search = 0; search < 200; ++search) {
    RandomStream rng({3, 7, search, 0});
    const auto ask = [&](double place, std::int64_t number) {
      EXPECT_EQ(place, place_of_run(place));
      std::int64_t num_events = 0;
      for (std::int64_t k = 0; k < number; ++k)
        num_events += rng.Uniform() < (place < 5.5 / 9.0 ? 0.05 : 0.3);
      return EventsAtLevel{place, num_events, number};
    };
    const Crossing found = FindCrossing(ask, 0.1, 3000, 0.95, place_of_run);
    EXPECT_GE(found.fresh.size(), 4u);
    for (size_t i = 1; i < found.fresh.size(); ++i) EXPECT_LT(found.fresh[i - 1].level, found.fresh[i].level);
    num_covered += found.interval.lower <= 5.0 / 9.0 && found.interval.upper >= 6.0 / 9.0;
    num_bracketed += std::isfinite(found.interval.lower) && std::isfinite(found.interval.upper);
    EXPECT_GE(found.estimate, found.interval.lower);
    EXPECT_LE(found.estimate, found.interval.upper);
  }
  EXPECT_GE(num_covered, 178);
  EXPECT_GE(num_bracketed, 190);
}

TEST(CrossingSearch, KnowsNothingAtFirstAndClosesIn) {
  CrossingSearch search(100, 0.5);
  EXPECT_EQ(search.Quantile(0.5), 50.0);
  for (size_t level = 0; level < 100; ++level) search.Add(level, level < 30 ? 0 : 200, 200);
  EXPECT_EQ(search.Quantile(0.01), 30.0);
  EXPECT_EQ(search.Quantile(0.99), 30.0);
}

// Each search has the exact guarantee; of 100 at .95 fewer than 86 hold with a probability of 2e-4, so that
// six curves raise a false alarm with 1e-3 at most.
TEST(FindCrossing, TheIntervalHoldsTheCrossingOfAnyCurve) {
  std::uint32_t row = 0;
  for (const KnownCrossing& curve : KnownCrossings(0.1)) {
    const CrossingCoverage coverage = MeasureCrossingCoverage(curve, 0.1, 1000, 100, row++);
    EXPECT_GE(coverage.num_covered, 86) << curve.name;
    if (curve.name == "logistic" || curve.name == "flat logistic") {
      // Asymptotic: between .90 and .99 allowed.
      EXPECT_GE(coverage.num_covered_logistic, 86) << curve.name;
      EXPECT_LE(coverage.num_covered_logistic, 100) << curve.name;
      EXPECT_LT(coverage.median_width_logistic, coverage.median_width) << curve.name;
    }
  }
}

// The power of the test above: a place that is off by .15 is held by hardly any interval, of 10,000 trials
// each.
TEST(FindCrossing, TheIntervalDoesNotHoldAnotherPlace) {
  for (const double off : {-0.15, 0.15}) {
    KnownCrossing logistic = KnownCrossings(0.1).at(0);
    logistic.crossing += off;
    EXPECT_LT(MeasureCrossingCoverage(logistic, 0.1, 10'000, 50, 0).num_covered, 10) << off;
  }
}

}  // namespace
}  // namespace rcme
