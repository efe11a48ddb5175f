#include "stats/weighted_rate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "stats/moments.h"
#include "stats/random.h"
#include "stats/tilted_binomial.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

WeightedEvents EqualWeights(int num_events, std::int64_t num_trials, double weight) {
  WeightedEvents events;
  for (int i = 0; i < num_events; ++i) events.Add(weight, true);
  events.max_weight = weight;
  events.num_trials = num_trials;
  return events;
}

TEST(WeightedRate, IsGarwoodsIntervalAtEqualWeights) {
  // Garwood's (1936) exact 95 % limits of a Poisson mean, as tabled (Ulm 1990, Am. J. Epidemiol.
  // 131:373-375).
  const struct {
    int events;
    double lower, upper;
    double last_digit_of_lower;
  } kPublished[] = {{0, 0.0, 3.689, 1e-4},      {1, 0.0253, 5.572, 1e-4},   {2, 0.2422, 7.225, 1e-4},
                    {3, 0.6187, 8.767, 1e-4},   {5, 1.6235, 11.668, 1e-4},  {10, 4.7954, 18.390, 1e-4},
                    {20, 12.217, 30.888, 1e-3}, {50, 37.111, 65.919, 1e-3}, {100, 81.364, 121.627, 1e-3}};
  for (const auto& published : kPublished) {
    for (const double weight : {1.0, 0.01}) {
      if (published.events == 0 && weight != 1.0)
        continue;  // no event, no weight seen: the mean weight counts
      const WeightedRate rate = EstimateWeightedRate(EqualWeights(published.events, 1000, weight));
      EXPECT_NEAR(rate.interval.lower * 1000.0 / weight, published.lower,
                  0.51 * published.last_digit_of_lower);
      EXPECT_NEAR(rate.interval.upper * 1000.0 / weight, published.upper, 0.51e-3);
      EXPECT_EQ(rate.cautious_upper, rate.interval.upper);
      EXPECT_NEAR(rate.estimate, weight * published.events / 1000.0, 1e-15);
      EXPECT_NEAR(rate.num_effective_events, published.events, 1e-9);
    }
  }
}

TEST(WeightedRate, KnownAnswersAtUnequalWeights) {
  // By scipy:  /usr/bin/python3 tests/known_answers/weighted_rate.py  (data of Fay & Feuer 1997, Down's
  // syndrome)
  const double cases[] = {0, 8, 63, 112, 262, 295};
  const double births[] = {327, 30666, 123419, 149919, 104088, 34392};
  const double all_births[] = {319933, 931318, 786511, 488235, 237863, 61313};
  WeightedEvents events;
  double total = 0.0;
  for (const double b : all_births) total += b;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < cases[i]; ++k) events.Add(all_births[i] / (births[i] * total), true);
  }
  events.num_trials = 1;
  const WeightedRate seen = EstimateWeightedRate(events);
  EXPECT_NEAR(1e5 * seen.estimate, 75.52900745, 1e-8);
  EXPECT_NEAR(1e5 * seen.interval.lower, 67.70212042, 1e-7);
  EXPECT_NEAR(1e5 * seen.interval.upper, 85.13545186, 1e-7);
  events.max_weight = all_births[0] / (births[0] * total);  // an age at which no case was seen
  EXPECT_NEAR(1e5 * EstimateWeightedRate(events).cautious_upper, 188.3001727, 1e-6);
}

TEST(WeightedRate, StandardErrorIsThatOfAMean) {
  // The same trials as a list of numbers w x.
  RandomStream rng({.seed = 1, .purpose = 61});
  WeightedEvents events, first_half, second_half;
  Moments numbers;
  for (int i = 0; i < 1000; ++i) {
    const double weight = rng.Uniform(0.0, 3.0);
    const bool happened = rng.Uniform() < 0.2;
    numbers.Add(happened ? weight : 0.0);
    events.Add(weight, happened);
    (i < 300 ? first_half : second_half).Add(weight, happened);
  }
  const WeightedRate rate = EstimateWeightedRate(events);
  EXPECT_NEAR(rate.estimate, numbers.mean(), 1e-14);
  EXPECT_NEAR(rate.standard_error, numbers.standard_error(), 1e-14);
  first_half.Merge(second_half);
  const WeightedRate merged = EstimateWeightedRate(first_half);
  EXPECT_NEAR(merged.interval.lower, rate.interval.lower, 1e-13);
  EXPECT_NEAR(merged.interval.upper, rate.interval.upper, 1e-13);
}

TEST(WeightedRate, WithoutTrialsAndWithEventsOfWeightZero) {
  EXPECT_EQ(EstimateWeightedRate({}).interval.upper, std::numeric_limits<double>::infinity());
  WeightedEvents events;
  events.Add(0.0, true);
  events.Add(1.5, false);
  const WeightedRate rate = EstimateWeightedRate(events);
  EXPECT_EQ(rate.estimate, 0.0);
  EXPECT_EQ(rate.num_effective_events, 0.0);
  EXPECT_EQ(rate.interval.lower, 0.0);
  EXPECT_NEAR(rate.interval.upper, 1.5 * 3.688879 / 2.0, 1e-6);  // no event: of the greatest weight
  EXPECT_NEAR(rate.cautious_upper, 1.5 * 3.688879 / 2.0, 1e-6);
}

// An experiment whose rate is known exactly: K of n matches are wrong, and the event happens with a
// probability that is logistic in K.
class LogisticFailure {
 public:
  static constexpr int kMatches = 100;
  static constexpr double kRatio = 0.2, kTiltedTo = 0.5;

  // The odds of failure grow by a factor exp(steepness) with every wrong match; they are even where it takes
  // the wanted rate.
  LogisticFailure(double rate, double steepness) : steepness_(steepness) {
    double low = 0.0, high = 200.0;
    for (int halving = 0; halving < 100; ++halving) {
      middle_ = 0.5 * (low + high);
      (Rate() > rate ? low : high) = middle_;
    }
    double sum_of_p = 0.0, sum_of_mixture = 0.0;
    for (int k = 0; k <= kMatches; ++k) {
      const double weight = TiltedBinomialWeight(k, kMatches, kRatio, kTiltedTo);
      weights_.push_back(weight);
      cdf_of_p_.push_back(sum_of_p += Probability(k));
      cdf_of_mixture_.push_back(sum_of_mixture += Probability(k) / weight);
    }
  }

  double Rate() const {
    double sum = 0.0;
    for (int k = 0; k <= kMatches; ++k) sum += Probability(k) * FailureProbability(k);
    return sum;
  }
  // E_mix[(w x)^2] = E_p[w x], minus the square of the rate; of one trial.
  double TiltedVariance() const {
    double sum = 0.0;
    for (int k = 0; k <= kMatches; ++k) sum += Probability(k) * Weight(k) * FailureProbability(k);
    return sum - Rate() * Rate();
  }

  WeightedEvents Run(int num_trials, bool is_tilted, RandomStream& rng) const {
    WeightedEvents events;
    const std::vector<double>& cdf = is_tilted ? cdf_of_mixture_ : cdf_of_p_;
    for (int trial = 0; trial < num_trials; ++trial) {
      const auto place = std::ranges::upper_bound(cdf, rng.Uniform());
      const int k = std::min(static_cast<int>(place - cdf.begin()), kMatches);
      events.Add(is_tilted ? Weight(k) : 1.0, rng.Uniform() < FailureProbability(k));
    }
    return events;
  }

 private:
  double FailureProbability(int k) const { return 1.0 / (1.0 + std::exp(-steepness_ * (k - middle_))); }
  double Weight(int k) const { return weights_[static_cast<size_t>(k)]; }
  static double Probability(int k) {
    return boost::math::pdf(boost::math::binomial(kMatches, kRatio), static_cast<double>(k));
  }

  double steepness_, middle_ = 0.0;
  std::vector<double> weights_, cdf_of_p_, cdf_of_mixture_;
};

constexpr double kZ = 3.89;  // two-sided, 1e-4

// What 4,000 experiments of 2,000 trials say about a rate.
struct Repeated {
  CoverageCount covers, covers_twice_the_rate, cautiously_above;
  Moments estimate, squared_error, num_effective;  // the first two relative to the rate
};

Repeated Repeat(const LogisticFailure& experiment, std::uint32_t condition) {
  const double rate = experiment.Rate();
  Repeated repeated;
  RandomStream rng({.seed = 1, .condition = condition, .purpose = 62});
  for (int i = 0; i < 4000; ++i) {
    const WeightedRate result = EstimateWeightedRate(experiment.Run(2000, true, rng));
    repeated.covers.Add(result.interval.Contains(rate));
    repeated.covers_twice_the_rate.Add(result.interval.Contains(2.0 * rate));
    repeated.cautiously_above.Add(result.cautious_upper >= rate);
    repeated.estimate.Add(result.estimate / rate);
    repeated.squared_error.Add(std::pow(result.standard_error / rate, 2.0));
    repeated.num_effective.Add(result.num_effective_events);
  }
  return repeated;
}

// Where the event is driven by the number that is tilted. Each z-test has a false-alarm rate of 1e-4, and
// sees a bias of 5 %.
TEST(WeightedRate, CoversTheTrueRateAndIsUnbiasedWhereFailureIsDrivenByTheTiltedNumber) {
  std::uint32_t condition = 0;
  for (const double wanted : {1e-2, 1e-4, 1e-6}) {
    const LogisticFailure experiment(wanted, 2.0);
    const double rate = experiment.Rate();
    ASSERT_NEAR(rate, wanted, 1e-9 * wanted);
    const Repeated repeated = Repeat(experiment, condition++);
    EXPECT_GT(repeated.covers.rate(), 0.94) << wanted << ": " << repeated.covers;
    EXPECT_TRUE(repeated.covers.interval().upper > 0.95) << wanted << ": " << repeated.covers;
    EXPECT_LT(repeated.covers_twice_the_rate.rate(), 0.2) << wanted << ": no power";
    EXPECT_GT(repeated.cautiously_above.rate(), 0.999) << wanted;
    EXPECT_LT(std::abs(repeated.estimate.mean() - 1.0), kZ * repeated.estimate.standard_error()) << wanted;
    EXPECT_GT(std::abs(repeated.estimate.mean() - 1.05), kZ * repeated.estimate.standard_error()) << wanted;
    const double squared_error = experiment.TiltedVariance() / (2000 * rate * rate);
    EXPECT_NEAR(repeated.squared_error.mean(), squared_error, kZ * repeated.squared_error.standard_error());
    // What it is good for: plain trials that would give the same standard error, per tilted trial.
    const double gain = rate * (1.0 - rate) / experiment.TiltedVariance();
    EXPECT_GT(gain, wanted > 1e-5 ? 5.0 : 5000.0);
    const std::string name = "rate_1e" + std::to_string(std::lround(std::log10(wanted)));
    RecordProperty(name + "_coverage", std::to_string(repeated.covers.rate()));
    RecordProperty(name + "_effective_events", std::to_string(repeated.num_effective.mean()));
    RecordProperty(name + "_gain_in_variance", std::to_string(gain));
    std::printf(
        "rate %.0e: coverage %.4f, effective events %.0f, relative error %.2f, gain in variance %.3g\n",
        wanted, repeated.covers.rate(), repeated.num_effective.mean(), std::sqrt(squared_error), gain);
  }
}

// What the header warns of, so that nobody has to believe it: where failure grows slowly with the tilted
// number, most of the rate sits at weights where no failure is seen. The interval says nothing then; the
// cautious end still holds.
TEST(WeightedRate, IntervalIsTooLowWhereFailureGrowsSlowly) {
  const Repeated slow = Repeat(LogisticFailure(1e-6, 0.5), 10);
  EXPECT_LT(slow.covers.interval().upper, 0.3) << slow.covers;
  EXPECT_GT(slow.cautiously_above.rate(), 0.999);
  const Repeated often = Repeat(LogisticFailure(1e-2, 0.5), 11);  // there is no harm where events are many
  EXPECT_GT(often.covers.interval().upper, 0.95) << often.covers;
}

// Tilted and untilted estimates of the same rate, 1e-2, from 400,000 trials each: they differ by less
// than 3.89 standard errors of the difference (1e-4), which is less than 4 % of the rate.
TEST(WeightedRate, AgreesWithBruteForceWhereThatIsFeasible) {
  const LogisticFailure experiment(1e-2, 2.0);
  RandomStream tilted_rng({.seed = 1, .purpose = 63}), plain_rng({.seed = 1, .purpose = 64});
  const WeightedRate tilted = EstimateWeightedRate(experiment.Run(400'000, true, tilted_rng));
  const WeightedRate plain = EstimateWeightedRate(experiment.Run(400'000, false, plain_rng));
  const double error = std::hypot(tilted.standard_error, plain.standard_error);
  EXPECT_LT(std::abs(tilted.estimate - plain.estimate), kZ * error);
  EXPECT_LT(kZ * error, 0.08 * 1e-2) << "no power";
}

}  // namespace
}  // namespace rcme
