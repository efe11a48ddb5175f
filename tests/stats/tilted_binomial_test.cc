#include "stats/tilted_binomial.h"

#include <gtest/gtest.h>

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <vector>

#include "stats/moments.h"
#include "stats/random.h"

namespace rcme {
namespace {

double Binomial(int k, int n, double p) {
  return boost::math::pdf(boost::math::binomial(n, p), static_cast<double>(k));
}

// P_mix(k) in its closed form, by Boost's incomplete beta function; from the side where both are small.
double MixtureProbability(int k, int n, double p, double q) {
  const double a = k + 1.0, b = n - k + 1.0;
  const bool is_left = k > n * 0.5 * (p + q);
  const double difference = is_left ? boost::math::ibeta(a, b, q) - boost::math::ibeta(a, b, p)
                                    : boost::math::ibetac(a, b, p) - boost::math::ibetac(a, b, q);
  return std::abs(difference) / ((n + 1.0) * std::abs(q - p));
}

TEST(TiltedBinomial, KnownAnswers) {
  // With 40 digits:  /usr/bin/python3 tests/known_answers/tilted_binomial.py
  const struct {
    int k, n;
    double p, q, weight;
  } kKnown[] = {{0, 1, 0.2, 0.5, 1.23076923076923},
                {1, 1, 0.2, 0.5, 5.71428571428571e-1},
                {0, 20, 0, 0.3, 6.30352080547506},
                {20, 20, 1, 0.4, 1.26000000554154e+1},
                {7, 20, 0.3, 0.6, 1.456096019191},
                {0, 100, 0.2, 0.6, 5.05e+1},
                {40, 100, 0.2, 0.6, 9.35786960384156e-5},
                {100, 100, 0.2, 0.6, 1.30648564643831e-46},
                {300, 500, 0.5, 0.4, 2.09218895688995e+1},
                {205000, 1000000, 0.2, 0.21, 1.88287377768878e-33},
                {199000, 1000000, 0.2, 0.6, 2.82149368159783e+3},
                {200500, 1000000, 0.2, 0.2001, 8.61479391234966e-1},
                {0, 1000000, 0.2, 0.6, 5.000005e+5}};
  for (const auto& known : kKnown) {
    EXPECT_NEAR(TiltedBinomialWeight(known.k, known.n, known.p, known.q), known.weight, 1e-10 * known.weight)
        << "k = " << known.k << ", n = " << known.n << ", p = " << known.p << ", q = " << known.q;
  }
}

TEST(TiltedBinomial, IsTheRatioOfTheTwoProbabilities) {
  // For every k, against Boost's binomial and incomplete beta function; where either rounds to nothing it
  // says nothing.
  for (const int n : {1, 2, 13, 100, 1000}) {
    for (const auto& [p, q] :
         {std::pair{0.2, 0.6}, {0.6, 0.2}, {0.05, 1.0}, {0.5, 0.51}, {0.0, 0.4}, {1.0, 0.3}}) {
      for (int k = 0; k <= n; ++k) {
        const double of_p = Binomial(k, n, p), of_mixture = MixtureProbability(k, n, p, q);
        const bool is_possible = (p > 0.0 || k == 0) && (p < 1.0 || k == n);
        if (of_mixture < 1e-250 || (is_possible && of_p < 1e-250)) continue;
        EXPECT_NEAR(TiltedBinomialWeight(k, n, p, q), of_p / of_mixture, 1e-9 * of_p / of_mixture + 1e-300)
            << "k = " << k << ", n = " << n << ", p = " << p << ", q = " << q;
      }
    }
  }
}

TEST(TiltedBinomial, TheMixtureIsTheMeanOfBinomials) {
  // The closed form itself against its definition, by the trapezium rule with 20,000 steps (error below
  // 1e-6).
  for (const int n : {5, 60}) {
    for (int k = 0; k <= n; ++k) {
      constexpr int kSteps = 4000;
      double sum = 0.0;
      for (int i = 0; i <= kSteps; ++i) {
        const double weight = i == 0 || i == kSteps ? 1.0 / 3.0 : i % 2 == 1 ? 4.0 / 3.0 : 2.0 / 3.0;
        sum += weight * Binomial(k, n, 0.2 + 0.4 * i / kSteps);
      }
      EXPECT_NEAR(MixtureProbability(k, n, 0.2, 0.6), sum / kSteps, 1e-9 * sum / kSteps);
    }
  }
}

TEST(TiltedBinomial, MeanWeightIsOne) {
  // Exactly, by summing over k: sum w P_mix = sum P_p = 1, and sum w P_mix k = n p: the mean under p.
  for (const int n : {1, 10, 500, 20'000}) {
    for (const auto& [p, q] : {std::pair{0.2, 0.6}, {0.7, 0.3}, {0.0, 0.5}, {1.0, 0.9}}) {
      double total = 0.0, mean = 0.0;
      for (int k = 0; k <= n; ++k) {
        const double part = TiltedBinomialWeight(k, n, p, q) * MixtureProbability(k, n, p, q);
        total += part;
        mean += part * k;
      }
      EXPECT_NEAR(total, 1.0, 1e-9) << "n = " << n << ", p = " << p << ", q = " << q;
      EXPECT_NEAR(mean, n * p, 1e-9 * n) << "n = " << n << ", p = " << p << ", q = " << q;
    }
  }
}

TEST(TiltedBinomial, MeanWeightIsOneWhereTheNumberIsDrawn) {
  // The draw itself: U uniform between p and q, n coins. z-tests at 1e-4 of mean w = 1 and mean w K = n p. A
  // weight for q = 0.35 where 0.3 was drawn is seen (that is what the last line says).
  RandomStream rng({.seed = 1, .purpose = 60});
  Moments weight, weighted_number, wrong;
  for (int i = 0; i < 100'000; ++i) {
    const double u = rng.Uniform(0.2, 0.3);
    int k = 0;
    for (int coin = 0; coin < 50; ++coin) k += rng.Uniform() < u;
    const double w = TiltedBinomialWeight(k, 50, 0.2, 0.3);
    weight.Add(w);
    weighted_number.Add(w * k);
    wrong.Add(TiltedBinomialWeight(k, 50, 0.2, 0.35));
  }
  constexpr double kZ = 3.89;
  EXPECT_LT(std::abs(weight.mean() - 1.0), kZ * weight.standard_error());
  EXPECT_LT(std::abs(weighted_number.mean() - 10.0), kZ * weighted_number.standard_error());
  EXPECT_GT(std::abs(wrong.mean() - 1.0), 2.0 * kZ * wrong.standard_error()) << "no power";
}

TEST(TiltedBinomial, Extremes) {
  // p = q: not tilted. k = 0 and p = 0: (n + 1) q / (1 - (1 - q)^(n + 1)). k impossible under p: 0.
  EXPECT_EQ(TiltedBinomialWeight(3, 10, 0.4, 0.4), 1.0);
  EXPECT_EQ(TiltedBinomialWeight(0, 10, 0.0, 0.0), 1.0);
  for (const int n : {1, 30, 1'000'000}) {
    const double closed = (n + 1.0) * 0.25 / -std::expm1((n + 1.0) * std::log1p(-0.25));
    EXPECT_NEAR(TiltedBinomialWeight(0, n, 0.0, 0.25), closed, 1e-10 * closed);
    EXPECT_NEAR(TiltedBinomialWeight(n, n, 1.0, 0.75), closed, 1e-10 * closed);
    EXPECT_EQ(TiltedBinomialWeight(1, n, 0.0, 0.25), 0.0);
    EXPECT_EQ(TiltedBinomialWeight(n - 1, n, 1.0, 0.75), 0.0);
  }
  // A q next to p hardly tilts.
  EXPECT_NEAR(TiltedBinomialWeight(105, 500, 0.2, 0.2 + 1e-12), 1.0, 1e-9);
}

TEST(TiltedBinomial, IsFiniteEverywhereAndMonotone) {
  for (const auto& [p, q] : {std::pair{0.2, 0.6}, {0.0, 1.0}, {1.0, 0.0}, {0.999, 0.001}, {1e-9, 1e-8}}) {
    for (const int n : {1, 1000, 1'000'000}) {
      double before = p < q ? INFINITY : 0.0;
      for (int step = 0; step <= 100; ++step) {
        const double weight = TiltedBinomialWeight(static_cast<int>(n * (step / 100.0)), n, p, q);
        ASSERT_TRUE(std::isfinite(weight) && weight >= 0.0) << n << " " << step << " " << p << " " << q;
        ASSERT_TRUE(p < q ? weight <= before * (1.0 + 1e-9) : weight >= before * (1.0 - 1e-9));
        before = weight;
      }
    }
  }
}

}  // namespace
}  // namespace rcme
