// Known answers, by a search for the restricted maximum likelihood instead of its closed form:
//   python3 tests/known_answers/paired.py
#include "stats/paired.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace rcme {
namespace {

// Sum of the trinomial probabilities of the pairs (first_only, second_only) for which `holds` is true: exact.
double PairedProbability(int n, double p_first_only, double p_second_only,
                         const std::function<bool(int, int)>& holds) {
  double sum = 0.0;
  for (int b = 0; b <= n; ++b) {
    for (int c = 0; b + c <= n; ++c) {
      const double log_p = std::lgamma(n + 1.0) - std::lgamma(b + 1.0) - std::lgamma(c + 1.0) -
                           std::lgamma(n - b - c + 1.0) + b * std::log(p_first_only) +
                           c * std::log(p_second_only) +
                           (n - b - c) * std::log1p(-p_first_only - p_second_only);
      if (log_p > -40.0 && holds(b, c)) sum += std::exp(log_p);
    }
  }
  return sum;
}

PairedCounts Discordant(int n, int b, int c) {
  return {.first_only = b, .second_only = c, .neither = n - b - c};
}

TEST(Paired, PublishedExamples) {
  // Fagerland, Lydersen & Laake (2014, Statistics in Medicine 33:2850), airway hyper-responsiveness of 21
  // children: Tango's interval (-0.517, -0.026), McNemar's exact p-value 0.070. PropCIs 0.3, scoreci.mp(25,
  // 28, 618, 0.9), which estimates second minus first: (-0.0148, 0.0247).
  const PairedCounts bentur{.both = 1, .first_only = 1, .second_only = 7, .neither = 12};
  EXPECT_NEAR(bentur.RiskDifference(), -6.0 / 21.0, 1e-15);
  EXPECT_NEAR(RiskDifferenceInterval(bentur).lower, -0.517, 5e-4);
  EXPECT_NEAR(RiskDifferenceInterval(bentur).upper, -0.026, 5e-4);
  EXPECT_NEAR(McNemarExactPValue(bentur), 0.070, 5e-4);
  EXPECT_NEAR(RiskDifferenceInterval(Discordant(618, 28, 25), 0.9).lower, -0.0148, 5e-5);
  EXPECT_NEAR(RiskDifferenceInterval(Discordant(618, 28, 25), 0.9).upper, 0.0247, 5e-5);
}

TEST(Paired, KnownAnswers) {
  const struct {
    PairedCounts counts;
    double confidence, lower, upper, p_value, anytime_p_value;
  } kKnown[] = {{{1, 1, 7, 12}, 0.95, -0.517232276, -0.026003034, 0.0703125, 0.298368298368},
                {{43, 0, 1, 0}, 0.95, -0.118077097, 0.059393231, 1, 1},
                {{0, 25, 28, 565}, 0.9, -0.024715482, 0.014834370, 0.783846302209, 1},
                {{0, 1, 5, 4732}, 0.95, -0.002280742, 0.000237882, 0.21875, 0.761904761905},
                {{100, 0, 0, 100}, 0.95, -0.018845326, 0.018845326, 1, 1},
                {{794, 150, 86, 570}, 0.95, 0.021361565, 0.058998033, 3.71593613957e-05, 0.00294170013755}};
  for (const auto& known : kKnown) {
    const Interval interval = RiskDifferenceInterval(known.counts, known.confidence);
    EXPECT_NEAR(interval.lower, known.lower, 2e-9);
    EXPECT_NEAR(interval.upper, known.upper, 2e-9);
    EXPECT_NEAR(McNemarExactPValue(known.counts), known.p_value, 1e-10 * known.p_value);
    EXPECT_NEAR(AnytimeMcNemarPValue(known.counts), known.anytime_p_value, 1e-10 * known.anytime_p_value);
  }
}

TEST(McNemar, NeverExceedsItsLevelAndHasPower) {
  // Exact sums, n = 200. An exact test of a discrete statistic is conservative, here down to 0.018; of rates
  // 0.05 and 0.15 in the discordant cells (a difference of 10 %) it sees the difference with power 0.88.
  const auto rejects = [](int b, int c) { return McNemarExactPValue(Discordant(200, b, c)) <= 0.05; };
  for (const double p : {0.02, 0.05, 0.1, 0.3}) {
    const double size = PairedProbability(200, p, p, rejects);
    EXPECT_LE(size, 0.05) << p;
    EXPECT_GT(size, 0.015) << p;
    RecordProperty("size_" + std::to_string(p), std::to_string(size));
  }
  EXPECT_GT(PairedProbability(200, 0.05, 0.15, rejects), 0.8);
}

// The probability that a test of equal rates is ever significant at 0.05 when it is looked at after every
// trial, until `num_discordant` trials were discordant (the others change nothing): exact, a walk over the
// number of those that went to the first, absorbed where the test rejects.
double ProbabilityOfEverRejecting(double p_first, int num_discordant,
                                  const std::function<double(const PairedCounts&)>& p_value) {
  std::vector<double> walk(static_cast<size_t>(num_discordant) + 1, 0.0);
  walk[0] = 1.0;
  double rejected = 0.0;
  for (int n = 1; n <= num_discordant; ++n) {
    for (int b = n; b >= 0; --b) {
      double& here = walk[static_cast<size_t>(b)];
      here = here * (1.0 - p_first) + (b > 0 ? walk[static_cast<size_t>(b) - 1] * p_first : 0.0);
      if (here > 0.0 && p_value(Discordant(n, b, n - b)) <= 0.05) rejected += here, here = 0.0;
    }
  }
  return rejected;
}

// Where the rates are equal, a study that stops as soon as it sees a difference finds one: McNemar's test in
// 41 % of the studies of 1,000 discordant trials. The test that is valid at every look errs at most as
// often as it says, and finds a real difference (three of five discordant trials against one) all the same.
TEST(McNemar, LookedAtAfterEveryTrialErrsFarTooOftenAndTheAnytimeValidOneDoesNot) {
  const double of_mcnemar = ProbabilityOfEverRejecting(0.5, 1000, McNemarExactPValue);
  const double of_anytime = ProbabilityOfEverRejecting(0.5, 1000, AnytimeMcNemarPValue);
  EXPECT_GT(of_mcnemar, 0.25);
  EXPECT_LE(of_anytime, 0.05);
  EXPECT_GT(of_anytime, 0.02) << "too cautious to be of use";
  EXPECT_GT(ProbabilityOfEverRejecting(0.6, 1000, AnytimeMcNemarPValue), 0.99);
  RecordProperty("mcnemar", std::to_string(of_mcnemar));
  RecordProperty("anytime", std::to_string(of_anytime));
}

TEST(RiskDifference, CoversAsOftenAsItSays) {
  // Exact sums, n = 150, rare and frequent events, equal and unequal rates: all within 0.945 and 0.954.
  for (const auto& [b_rate, c_rate] :
       {std::pair{0.2, 0.2}, {0.05, 0.15}, {0.02, 0.02}, {0.3, 0.1}, {0.01, 0.06}, {0.4, 0.4}}) {
    const double difference = b_rate - c_rate;
    const double coverage = PairedProbability(150, b_rate, c_rate, [&](int b, int c) {
      return RiskDifferenceInterval(Discordant(150, b, c)).Contains(difference);
    });
    EXPECT_GT(coverage, 0.945) << b_rate << ", " << c_rate;
    EXPECT_LT(coverage, 0.955) << b_rate << ", " << c_rate;
    RecordProperty("coverage_" + std::to_string(b_rate) + "_" + std::to_string(c_rate),
                   std::to_string(coverage));
  }
  // Power: a difference of 0.1 excludes zero.
  EXPECT_GT(PairedProbability(
                200, 0.05, 0.15,
                [](int b, int c) { return !RiskDifferenceInterval(Discordant(200, b, c)).Contains(0.0); }),
            0.85);
}

TEST(Paired, CountsAndEnds) {
  PairedCounts counts, more;
  counts.Add(true, true), counts.Add(true, false), counts.Add(false, true), more.Add(false, true);
  more.Add(false, false);
  counts.Merge(more);
  EXPECT_EQ(counts.both, 1);
  EXPECT_EQ(counts.first_only, 1);
  EXPECT_EQ(counts.second_only, 2);
  EXPECT_EQ(counts.neither, 1);
  EXPECT_EQ(counts.n(), 5);
  EXPECT_EQ(RiskDifferenceInterval({}).lower, -1.0);
  EXPECT_EQ(RiskDifferenceInterval({}).upper, 1.0);
  EXPECT_EQ(McNemarExactPValue({.both = 3, .neither = 9}), 1.0);
  // Swapping the methods mirrors the interval; one that always wins has its end at 1.
  const Interval interval = RiskDifferenceInterval(Discordant(50, 9, 2)),
                 mirrored = RiskDifferenceInterval(Discordant(50, 2, 9));
  EXPECT_NEAR(interval.lower, -mirrored.upper, 1e-12);
  EXPECT_NEAR(interval.upper, -mirrored.lower, 1e-12);
  EXPECT_NEAR(RiskDifferenceInterval(Discordant(50, 50, 0)).upper, 1.0, 1e-12);
}

}  // namespace
}  // namespace rcme
