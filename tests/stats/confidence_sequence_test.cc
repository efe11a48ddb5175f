// Known answers: the mixture by Simpson's rule over the prior instead of beta functions,
//   python3 tests/known_answers/confidence_sequence.py
#include "stats/confidence_sequence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

constexpr int kTrials = 10'000;

// For each n the counts of successes whose interval holds the true p; they are contiguous, and from one n to
// the next each end stays or rises by one.
struct Band {
  std::vector<int> lowest, highest;
};
Band FindBand(double p, const std::function<Interval(int, int)>& interval) {
  Band band{{0}, {0}};
  for (int n = 1; n <= kTrials; ++n) {
    int low = band.lowest.back(), high = band.highest.back() + 1;
    if (!interval(low, n).Contains(p)) ++low;
    if (!interval(high, n).Contains(p)) --high;
    EXPECT_TRUE(interval(low, n).Contains(p) && interval(high, n).Contains(p)) << "n = " << n;
    band.lowest.push_back(low);
    band.highest.push_back(high);
  }
  return band;
}

// P(the interval excludes p after any of the first kTrials trials), exactly: the binomial walk, absorbed
// where it leaves the band.
double ProbabilityOfEverExcluding(double p, const Band& band) {
  std::vector<double> walk(kTrials + 2, 0.0);
  walk[0] = 1.0;
  double absorbed = 0.0;
  for (size_t n = 1; n <= kTrials; ++n) {
    const int low = band.lowest[n], high = band.highest[n];
    for (int s = band.highest[n - 1] + 1; s >= band.lowest[n - 1]; --s) {
      double& here = walk[static_cast<size_t>(s)];
      here = here * (1.0 - p) + (s > band.lowest[n - 1] ? walk[static_cast<size_t>(s) - 1] * p : 0.0);
      if (s < low || s > high) absorbed += here, here = 0.0;
    }
  }
  return absorbed;
}

bool EverExcludes(RandomStream& rng, double p, const Band& band) {
  int successes = 0;
  for (size_t n = 1; n <= kTrials; ++n) {
    successes += rng.Uniform() < p ? 1 : 0;
    if (successes < band.lowest[n] || successes > band.highest[n]) return true;
  }
  return false;
}

TEST(ConfidenceSequence, KnownAnswers) {
  const struct {
    int s, n;
    double confidence, prior, lower, upper, log_ratio_at_09;
  } kKnown[] = {{0, 20, 0.95, 0.5, 0, 0.224006112013, 43.9752214307},
                {8, 10, 0.95, 0.5, 0.342478608418, 0.990606240233, -0.9671380199},
                {8, 10, 0.95, 1.0, 0.353042192076, 0.989516904781, -0.756503451318},
                {950, 1000, 0.95, 0.5, 0.920760418189, 0.97128008274, 13.0258716798},
                {3, 200, 0.99, 1.0, 0.000343505460913, 0.0799617361482, 434.533910206},
                {9500, 10000, 0.999, 0.5, 0.938730688903, 0.95986227111, 162.233954196}};
  for (const auto& known : kKnown) {
    const BetaPrior prior{known.prior, known.prior};
    const Interval interval = ConfidenceSequence(known.s, known.n, known.confidence, prior);
    EXPECT_NEAR(interval.lower, known.lower, 1e-9 * known.lower) << known.s << " of " << known.n;
    EXPECT_NEAR(interval.upper, known.upper, 1e-9 * known.upper) << known.s << " of " << known.n;
    EXPECT_NEAR(LogMixtureLikelihoodRatio(known.s, known.n, 0.9, prior), known.log_ratio_at_09, 1e-8);
  }
}

TEST(ConfidenceSequence, RatioIsAMartingale) {
  // E[M_(n+1) | s successes in n] = M_n at the true p: p M(s + 1, n + 1) + (1 - p) M(s, n + 1) = M(s, n).
  const BetaPrior prior{2.0, 0.7};
  for (const double p : {0.05, 0.5, 0.93}) {
    for (int n = 0; n < 40; ++n) {
      for (int s = 0; s <= n; ++s) {
        const auto ratio = [&](int successes, int trials) {
          return std::exp(LogMixtureLikelihoodRatio(successes, trials, p, prior));
        };
        EXPECT_NEAR(p * ratio(s + 1, n + 1) + (1.0 - p) * ratio(s, n + 1), ratio(s, n), 1e-11 * ratio(s, n));
      }
    }
    EXPECT_NEAR(LogMixtureLikelihoodRatio(0, 0, p, prior), 0.0, 1e-14);
  }
}

TEST(ConfidenceSequence, AnAsymmetricPriorFavoursItsOwnSide) {
  // One trial: the mixture is the prior's mean, a / (a + b) for a success.
  const BetaPrior prior{2.0, 0.7};
  EXPECT_NEAR(std::exp(LogMixtureLikelihoodRatio(1, 1, 0.4, prior)), 2.0 / 2.7 / 0.4, 1e-14);
  EXPECT_NEAR(std::exp(LogMixtureLikelihoodRatio(0, 1, 0.4, prior)), 0.7 / 2.7 / 0.6, 1e-14);
}

TEST(ConfidenceSequence, WatchedAfterEveryTrialItExcludesTheTruthAtMostAsOftenAsItSays) {
  // Exact probabilities over 10,000 looks, no random numbers. The exact interval watched like that excludes
  // the truth in about half of the studies.
  for (const double p : {0.5, 0.95}) {
    const Band sequence = FindBand(p, [](int s, int n) { return ConfidenceSequence(s, n); });
    const Band exact = FindBand(p, [](int s, int n) { return ExactBinomialInterval(s, n); });
    const double of_sequence = ProbabilityOfEverExcluding(p, sequence);
    const double of_exact = ProbabilityOfEverExcluding(p, exact);
    EXPECT_LE(of_sequence, 0.05) << "p = " << p;
    EXPECT_GT(of_sequence, 0.01) << "p = " << p << ": too wide to be of use";
    EXPECT_GT(of_exact, 0.3) << "p = " << p;
    RecordProperty("sequence_p" + std::to_string(static_cast<int>(100 * p)), std::to_string(of_sequence));
    RecordProperty("exact_p" + std::to_string(static_cast<int>(100 * p)), std::to_string(of_exact));

    // The same by simulation, 4000 sequences.
    CoverageCount sequence_excludes, exact_excludes;
    for (std::uint32_t trial = 0; trial < 4000; ++trial) {
      RandomStream rng({.seed = 1, .condition = p == 0.5 ? 0u : 1u, .trial = trial, .purpose = 60});
      RandomStream same = rng;
      sequence_excludes.Add(EverExcludes(rng, p, sequence));
      exact_excludes.Add(EverExcludes(same, p, exact));
    }
    EXPECT_TRUE(sequence_excludes.Admits(of_sequence)) << sequence_excludes << ", not " << of_sequence;

    EXPECT_TRUE(exact_excludes.Admits(of_exact)) << exact_excludes << ", not " << of_exact;
    EXPECT_GT(exact_excludes.interval().lower, 0.3) << exact_excludes;
  }
}

TEST(ConfidenceSequence, HasPower) {
  // A claimed coverage of 0.95 that is 0.93: excluded within 10,000 trials with probability above 0.99
  // (exact).
  EXPECT_GT(ProbabilityOfEverExcluding(0.93, FindBand(0.93,
                                                      [](int s, int n) {
                                                        Interval of_claim = ConfidenceSequence(s, n);
                                                        of_claim.lower -= 0.02,
                                                            of_claim.upper -=
                                                            0.02;  // holds 0.93 where the interval holds 0.95
                                                        return of_claim;
                                                      })),
            0.99);
}

TEST(ConfidenceSequence, IsAtMostThreeTimesAsWideAsTheExactInterval) {
  for (const int n : {100, 1000, 10'000, 1'000'000}) {
    const int s = n / 20;
    const Interval sequence = ConfidenceSequence(s, n), exact = ExactBinomialInterval(s, n);
    EXPECT_LT(sequence.upper - sequence.lower, 3.0 * (exact.upper - exact.lower)) << n;
    EXPECT_LT(sequence.lower, exact.lower);
    EXPECT_GT(sequence.upper, exact.upper);
  }
}

TEST(ConfidenceSequence, Ends) {
  EXPECT_EQ(ConfidenceSequence(0, 0).lower, 0.0);
  EXPECT_EQ(ConfidenceSequence(0, 0).upper, 1.0);
  EXPECT_EQ(ConfidenceSequence(0, 50).lower, 0.0);
  EXPECT_EQ(ConfidenceSequence(50, 50).upper, 1.0);
  EXPECT_EQ(LogMixtureLikelihoodRatio(1, 2, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(LogMixtureLikelihoodRatio(1, 2, 1.0), std::numeric_limits<double>::infinity());
  EXPECT_THROW(ConfidenceSequence(3, 2), std::invalid_argument);
  EXPECT_THROW(ConfidenceSequence(1, 2, 0.95, {0.0, 1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
