#include "stats/risk_control.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

double BinomialCdf(std::int64_t k, std::int64_t n, double p) {
  double sum = 0.0;
  for (std::int64_t i = 0; i <= k; ++i) {
    const double x = static_cast<double>(i), rest = static_cast<double>(n - i);
    sum += std::exp(std::lgamma(x + rest + 1.0) - std::lgamma(x + 1.0) - std::lgamma(rest + 1.0) +
                    x * std::log(p) + rest * std::log1p(-p));
  }
  return sum;
}

// Sample sizes of one-sided 95 % / 95 % tolerance limits (Wilks 1941, as tabulated for safety analyses): with
// 59 samples the largest is a limit, with 93 the second largest, ...
TEST(RiskControl, WilksSampleSizes) {
  EXPECT_EQ(FewestCertifyingTrials(0.05, 0.05), 59);
  constexpr std::int64_t kWilks[] = {59, 93, 124, 153, 181, 208};
  for (std::int64_t k = 0; k < 6; ++k) {
    EXPECT_EQ(LargestCertifyingCount(kWilks[k], 0.05, 0.05), k);
    EXPECT_EQ(LargestCertifyingCount(kWilks[k] - 1, 0.05, 0.05), k - 1);
  }
}

TEST(RiskControl, LargestCountIsTheLastWhoseTailIsAtMostDelta) {
  for (const std::int64_t n : {1, 10, 100, 1000}) {
    for (const double at_most : {0.01, 0.2, 0.5}) {
      for (const double delta : {0.01, 0.1}) {
        const std::int64_t k = LargestCertifyingCount(n, at_most, delta);
        if (k >= 0) {
          EXPECT_LE(BinomialCdf(k, n, at_most), delta);
        }
        EXPECT_GT(BinomialCdf(k + 1, n, at_most), delta);
      }
    }
  }
  EXPECT_EQ(LargestCertifyingCount(0, 0.1, 0.05), -1);
  EXPECT_EQ(ExcessPValue({0, 0}, 0.1), 1.0);
}

TEST(RiskControl, TrialsToCertifyHaveThePowerAndNotManyFewerDo) {
  for (const double rate : {0.0, 0.02, 0.04}) {
    const std::int64_t n = TrialsToCertify(rate, 0.05, 0.05, 0.9);
    const auto power = [&](std::int64_t trials) {
      return ExcessPValue({LargestCertifyingCount(trials, 0.05, 0.05), trials}, rate);
    };
    EXPECT_GE(power(n), 0.9);
    if (rate > 0.0) {
      EXPECT_LT(power(n * 9 / 10), 0.9);
    }
  }
  EXPECT_EQ(TrialsToCertify(0.0, 0.05, 0.05, 0.9), 59);
  EXPECT_GT(TrialsToCertify(std::nextafter(0.05, 0.0), 0.05, 0.05, 0.9), std::int64_t{1} << 50);
  EXPECT_THROW(TrialsToCertify(0.05, 0.05, 0.05, 0.9), std::invalid_argument);
}

TEST(RiskControl, ASequenceEndsAtTheFirstThatIsNotCertified) {
  EXPECT_EQ(CountCertified({0.01, 0.05, 0.051, 0.0}, 0.05), 2u);
  EXPECT_EQ(CountCertified({0.2, 0.0}, 0.05), 0u);
  EXPECT_EQ(CountCertified({}, 0.05), 0u);
  EXPECT_EQ(CountCertified({0.0, std::numeric_limits<double>::quiet_NaN(), 0.0}, 0.05), 1u);
}

// A threshold tuned on n normal numbers so that at most 10 % of further ones exceed it: the share that does
// is 1 - Phi, known exactly. It is above 10 % in at most delta of the repetitions, and not in far fewer: the
// rule wastes no more than one order statistic. Trials come in halves of different means, as the conditions
// of a study do.
TEST(RiskControl, ATunedThresholdViolatesNoMoreOftenThanDelta) {
  constexpr int kRepetitions = 20'000, kTrials = 300;
  constexpr double kAtMost = 0.1, kDelta = 0.1;
  const std::int64_t k = LargestCertifyingCount(kTrials, kAtMost, kDelta);
  for (const double shift : {0.0, 1.0}) {
    std::int64_t num_violations = 0;
    for (std::uint32_t r = 0; r < kRepetitions; ++r) {
      RandomStream rng({1, 0, r, 5});
      std::vector<double> values(kTrials);
      for (int i = 0; i < kTrials; ++i) values[static_cast<size_t>(i)] = rng.Normal() + (i % 2) * shift;
      std::ranges::nth_element(values, values.begin() + k, std::greater<>());
      const double threshold = values[static_cast<size_t>(k)];
      const double exceeding = 0.25 * std::erfc(threshold / std::sqrt(2.0)) +
                               0.25 * std::erfc((threshold - shift) / std::sqrt(2.0));
      num_violations += exceeding > kAtMost;
    }
    const Interval rate = ExactBinomialInterval(num_violations, kRepetitions, 1.0 - 1e-5);
    EXPECT_LT(rate.lower, kDelta) << shift;
    EXPECT_GT(rate.upper, 0.6 * kDelta) << shift;
  }
}

// KL(.01 || .05) = .01 log(.2) + .99 log(.99 / .95) = .024736; Bentkus' bound is e P(Binomial(100, .05) <=
// 1).
TEST(MeanLossPValue, KnownAnswers) {
  EXPECT_EQ(MeanLossPValue(0.0, 0, 0.05), 1.0);
  EXPECT_EQ(MeanLossPValue(0.06, 100, 0.05), 1.0);
  EXPECT_NEAR(MeanLossPValue(0.0, 149, 0.02), std::pow(0.98, 149), 1e-12);
  const double divergence = 0.01 * std::log(0.2) + 0.99 * std::log(0.99 / 0.95);
  const double bentkus = std::exp(1.0) * (std::pow(0.95, 100) + 100 * 0.05 * std::pow(0.95, 99));
  EXPECT_NEAR(MeanLossPValue(0.01, 100, 0.05), std::min(std::exp(-100 * divergence), bentkus), 1e-9);
}

// Losses of mean .05 that are far from binomial: rejected at level .05 in at most 5 % of 4,000 samples, and
// losses of mean .02 nearly always.
TEST(MeanLossPValue, KeepsItsLevel) {
  RandomStream rng({.seed = 1, .purpose = 415});
  for (const auto& [share, loss, is_at_most] :
       {std::tuple{0.1, 0.5, true}, {0.05, 1.0, true}, {0.04, 0.5, false}}) {
    int rejected = 0;
    for (int repetition = 0; repetition < 4000; ++repetition) {
      double sum = 0.0;
      for (int i = 0; i < 400; ++i) sum += rng.Uniform() < share ? loss : 0.0;
      rejected += MeanLossPValue(sum / 400, 400, 0.05) <= 0.05;
    }
    if (is_at_most) {
      EXPECT_LE(ExactBinomialInterval(rejected, 4000, 0.999).lower, 0.05) << share;
    } else {
      EXPECT_GE(rejected, 3000) << share;
    }
  }
}

}  // namespace
}  // namespace rcme
