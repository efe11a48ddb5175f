// Known answers, from the mean squares of an analysis of variance: python3
// tests/known_answers/variance_split.py
#include "stats/variance_split.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

VarianceSplit ComputeSplit(const std::vector<int>& counts, int num_repeats) {
  RepeatedEvents events(num_repeats);
  for (const int count : counts) events.AddScene(count);
  return events.Split();
}

// The list so many times over.
std::vector<int> Times(int times, const std::vector<int>& counts) {
  std::vector<int> all;
  for (int i = 0; i < times; ++i) all.insert(all.end(), counts.begin(), counts.end());
  return all;
}
std::vector<int> Joined(std::vector<int> all, const std::vector<int>& more) {
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(VarianceSplit, KnownAnswers) {
  const struct {
    std::vector<int> counts;
    int num_repeats;
    double between, within, share, lower, upper;
  } kKnown[] = {{Joined(Joined(Times(30, {0}), Times(10, {5})), Times(8, {2, 3, 1, 4})), 5, 0.121596244131,
                 0.111111111111, 0.477471418964, 0.3654750437, 0.6129846849},
                {Joined(Joined(Times(60, {0}), Times(10, {1})), Times(30, {2})), 2, 0.179545454545, 0.05,
                 0.217821782178, 0.1061751423, 0.4076938214},
                {Joined(Times(20, {0}), Times(20, {10})), 10, 0.25641025641, 0.0, 0.0, 0.0, 0.1899969193},
                // Fewer differences between scenes than chance alone makes.
                {Times(12, {1, 2, 3, 2}), 4, -0.0410017730496, 0.291666666667, 1.0, 1.0, 1.0}};
  for (const auto& known : kKnown) {
    const VarianceSplit split = ComputeSplit(known.counts, known.num_repeats);
    EXPECT_NEAR(split.between, known.between, 1e-11);
    EXPECT_NEAR(split.within, known.within, 1e-11);
    EXPECT_NEAR(split.within_share, known.share, 1e-11);
    EXPECT_NEAR(split.within_share_interval.lower, known.lower, 1e-8);
    EXPECT_NEAR(split.within_share_interval.upper, known.upper, 1e-8);
  }
}

TEST(VarianceSplit, ScenesOfBothOutcomesAreCountedExactly) {
  const VarianceSplit split = ComputeSplit(Joined(Times(6, {0, 1, 2}), {1, 1}), 2);
  EXPECT_EQ(split.num_scenes, 20);
  EXPECT_EQ(split.num_mixed, 8);
  EXPECT_EQ(split.mixed_interval.lower, ExactBinomialInterval(8, 20).lower);
  EXPECT_EQ(split.mixed_interval.upper, ExactBinomialInterval(8, 20).upper);
}

TEST(VarianceSplit, WhatSaysTooLittleHasNoInterval) {
  EXPECT_TRUE(std::isnan(ComputeSplit({}, 3).within));
  EXPECT_TRUE(std::isnan(ComputeSplit({2}, 3).within_share));
  const VarianceSplit nothing = ComputeSplit(Times(50, {0}), 3);
  EXPECT_EQ(nothing.within, 0.0);
  EXPECT_EQ(nothing.between, 0.0);
  EXPECT_TRUE(std::isnan(nothing.within_share)) << "nothing varies";
  EXPECT_EQ(nothing.mixed_interval.lower, 0.0);
  for (const int event : {0, 3}) {  // nine scenes that differ from the others
    const VarianceSplit few = ComputeSplit(Joined(Times(50, {event}), Times(9, {2})), 3);
    EXPECT_GT(few.within_share, 0.0);
    EXPECT_EQ(few.within_share_interval.lower, 0.0);
    EXPECT_EQ(few.within_share_interval.upper, 1.0);
    EXPECT_LT(ComputeSplit(Joined(Times(50, {event}), Times(10, {2})), 3).within_share_interval.upper -
                  ComputeSplit(Joined(Times(50, {event}), Times(10, {2})), 3).within_share_interval.lower,
              1.0);
  }
  EXPECT_THROW(RepeatedEvents(1), std::invalid_argument);
  EXPECT_THROW(ComputeSplit({4}, 3), std::invalid_argument);
  EXPECT_THROW(ComputeSplit({-1}, 3), std::invalid_argument);
}

// Three scenes of three repeats, p_i = 0.2 or 0.9 with equal chance: the mean of either part over all 64
// outcomes is what it estimates. Var(p_i) = 0.35^2, E[p_i (1 - p_i)] = (0.16 + 0.09) / 2.
TEST(VarianceSplit, IsUnbiased) {
  const auto probability = [](int k) {
    const double choices = k == 0 || k == 3 ? 1.0 : 3.0;
    return 0.5 * choices *
           (std::pow(0.2, k) * std::pow(0.8, 3 - k) + std::pow(0.9, k) * std::pow(0.1, 3 - k));
  };
  double between = 0.0, within = 0.0;
  for (int a = 0; a <= 3; ++a) {
    for (int b = 0; b <= 3; ++b) {
      for (int c = 0; c <= 3; ++c) {
        const double weight = probability(a) * probability(b) * probability(c);
        const VarianceSplit split = ComputeSplit({a, b, c}, 3);
        between += weight * split.between;
        within += weight * split.within;
      }
    }
  }
  EXPECT_NEAR(between, 0.1225, 1e-13);
  EXPECT_NEAR(within, 0.125, 1e-13);
}

// SceneLaws of the scenes' probabilities with the share within that they make.
struct SceneLaw {
  const char* name;
  double within_share;
  std::function<double(RandomStream&)> draw;
};
const std::vector<SceneLaw>& SceneLaws() {
  static const std::vector<SceneLaw> laws = {
      {"no scene differs", 1.0, [](RandomStream&) { return 0.2; }},
      {"uniform", 2.0 / 3.0, [](RandomStream& rng) { return rng.Uniform(); }},
      {"the scene alone decides", 0.0, [](RandomStream& rng) { return rng.Uniform() < 0.3 ? 1.0 : 0.0; }},
      // p = 0.1 0.8 = 0.08, E[p_i (1 - p_i)] = 0.1 0.16
      {"one in ten is hard", 0.016 / (0.08 * 0.92),
       [](RandomStream& rng) { return rng.Uniform() < 0.1 ? 0.8 : 0.0; }},
      // p = 0.2 + 0.8 0.1 = 0.28, E = 0.8 0.09
      {"impossible or easy", 0.072 / (0.28 * 0.72),
       [](RandomStream& rng) { return rng.Uniform() < 0.2 ? 1.0 : 0.1; }},
      // p = 0.495, E = 0.5 0.0099
      {"hardly ever flips", 0.00495 / (0.495 * 0.505),
       [](RandomStream& rng) { return rng.Uniform() < 0.5 ? 0.99 : 0.0; }}};
  return laws;
}

// 2,000 runs per law, number of scenes and of repeats. The interval says 95 %; asserted is that it is not
// below 93 %, beyond chance (1e-4 each).
TEST(VarianceSplit, IntervalCovers) {
  std::uint32_t condition = 0;
  double least = 1.0;
  for (const SceneLaw& law : SceneLaws()) {
    for (const int num_scenes : {30, 100, 400}) {
      for (const int num_repeats : {2, 5, 10}) {
        CoverageCount covered;
        for (std::uint32_t run = 0; run < 2000; ++run) {
          RandomStream rng({.seed = 1, .condition = condition, .trial = run, .purpose = 320});
          RepeatedEvents events(num_repeats);
          for (int scene = 0; scene < num_scenes; ++scene) {
            const double p = law.draw(rng);
            int num_events = 0;
            for (int r = 0; r < num_repeats; ++r) num_events += rng.Uniform() < p;
            events.AddScene(num_events);
          }
          const Interval interval = events.Split().within_share_interval;
          covered.Add(interval.lower <= law.within_share && law.within_share <= interval.upper);
        }
        EXPECT_GE(covered.interval().upper, 0.93)
            << law.name << ", " << num_scenes << " scenes, " << num_repeats << " repeats: " << covered;
        least = std::min(least, covered.rate());
        ++condition;
      }
    }
  }
  RecordProperty("least", std::to_string(least));
}

// A hundred scenes of ten repeats tell "half and half" from "all of the scene" and from "all chance".
TEST(VarianceSplit, IntervalIsNarrowEnoughToBeOfUse) {
  RandomStream rng({.seed = 1, .purpose = 321});
  RepeatedEvents events(10);
  for (int scene = 0; scene < 100; ++scene) {
    const double p = SceneLaws()[4].draw(rng);
    int num_events = 0;
    for (int r = 0; r < 10; ++r) num_events += rng.Uniform() < p;
    events.AddScene(num_events);
  }
  const Interval interval = events.Split().within_share_interval;
  EXPECT_GT(interval.lower, 0.2);
  EXPECT_LT(interval.upper, 0.6);
}

}  // namespace
}  // namespace rcme
