#include "stats/intervals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rcme {
namespace {

// P(X = k) of Binomial(n, p), 0 < p < 1.
double BinomialProbability(int k, int n, double p) {
  return std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + k * std::log(p) +
                  (n - k) * std::log1p(-p));
}

double ProbabilityOfAtLeast(int k, int n, double p) {
  double sum = 0.0;
  for (int i = n; i >= k; --i) sum += BinomialProbability(i, n, p);
  return sum;
}

double ProbabilityOfAtMost(int k, int n, double p) {
  double sum = 0.0;
  for (int i = 0; i <= k; ++i) sum += BinomialProbability(i, n, p);
  return sum;
}

TEST(ExactBinomialInterval, ClosedFormsAtTheEnds) {
  // k = 0: (1 - upper)^n = tail, k = n: lower^n = tail.
  for (const int n : {1, 2, 10, 4738, 1'000'000}) {
    for (const double confidence : {0.9, 0.95, 0.9999}) {
      const double tail = 0.5 * (1.0 - confidence);
      const Interval none = ExactBinomialInterval(0, n, confidence);
      EXPECT_EQ(none.lower, 0.0);
      EXPECT_NEAR(none.upper, -std::expm1(std::log(tail) / n), 1e-10 * none.upper);
      const Interval all = ExactBinomialInterval(n, n, confidence);
      EXPECT_EQ(all.upper, 1.0);
      EXPECT_NEAR(all.lower, std::pow(tail, 1.0 / n), 1e-12);
    }
  }
}

TEST(ExactBinomialInterval, KnownAnswers) {
  // By bisection of exact sums:  python3 tests/known_answers/clopper_pearson.py
  // The first three are rows of the paper's table, recomputed.
  const struct {
    int k, n;
    double confidence, lower, upper;
  } kKnown[] = {{1, 4738, 0.95, 5.34355009302e-6, 0.00117538120006},
                {68, 4738, 0.95, 0.0111617007789, 0.0181596057906},
                {0, 10078, 0.95, 0.0, 0.000365965907013},
                {8, 10, 0.95, 0.443904537692, 0.974789273673},
                {3, 200, 0.99, 0.00169638098828, 0.0538034452286},
                {900, 1000, 0.9999, 0.858395150401, 0.933156025468}};
  for (const auto& known : kKnown) {
    const Interval interval = ExactBinomialInterval(known.k, known.n, known.confidence);
    EXPECT_NEAR(interval.lower, known.lower, 1e-10 * known.lower) << known.k << " of " << known.n;
    EXPECT_NEAR(interval.upper, known.upper, 1e-10 * known.upper) << known.k << " of " << known.n;
  }
}

TEST(ExactBinomialInterval, EachEndLeavesItsTailOutside) {
  // The definition, by summing binomial probabilities.
  for (const int n : {7, 40, 150}) {
    for (int k = 1; k < n; ++k) {
      const Interval interval = ExactBinomialInterval(k, n, 0.95);
      EXPECT_NEAR(ProbabilityOfAtLeast(k, n, interval.lower), 0.025, 1e-9) << k << " of " << n;
      EXPECT_NEAR(ProbabilityOfAtMost(k, n, interval.upper), 0.025, 1e-9) << k << " of " << n;
    }
  }
}

TEST(ExactBinomialInterval, CoversEveryProbabilityAtLeastAsOftenAsItSays) {
  // Exact, no random numbers: the coverage at p is the sum of P(X = k) over the k whose interval holds p.
  for (const int n : {1, 5, 20, 100}) {
    std::vector<Interval> intervals;
    for (int k = 0; k <= n; ++k) intervals.push_back(ExactBinomialInterval(k, n));
    double least = 1.0, sum = 0.0;
    constexpr int kSteps = 2000;
    for (int step = 1; step < kSteps; ++step) {
      const double p = static_cast<double>(step) / kSteps;
      double coverage = 0.0;
      for (int k = 0; k <= n; ++k) {
        if (intervals[static_cast<size_t>(k)].Contains(p)) coverage += BinomialProbability(k, n, p);
      }
      EXPECT_GE(coverage, 0.95 - 1e-9) << "n = " << n << ", p = " << p;
      least = std::min(least, coverage);
      sum += coverage;
    }
    // Nor is it too wide: at n = 100 it comes within 1 % of its promise somewhere and averages below 0.97.
    // (The interval p_hat +- 1.96 s covers 0.95 nowhere near 0; [0, 1] covers 1.)
    if (n == 100) {
      EXPECT_LT(least, 0.96);
      EXPECT_LT(sum / (kSteps - 1), 0.97);
    }
  }
}

TEST(ExactBinomialInterval, IsSymmetric) {
  for (int k = 0; k <= 30; ++k) {
    const Interval interval = ExactBinomialInterval(k, 30, 0.99),
                   mirrored = ExactBinomialInterval(30 - k, 30, 0.99);
    EXPECT_NEAR(interval.lower, 1.0 - mirrored.upper, 1e-12);
    EXPECT_TRUE(interval.Contains(k / 30.0));
  }
}

TEST(ExactBinomialInterval, KnowsNothingWithoutTrials) {
  const Interval interval = ExactBinomialInterval(0, 0);
  EXPECT_EQ(interval.lower, 0.0);
  EXPECT_EQ(interval.upper, 1.0);
}

TEST(Interval, HoldsItsEnds) {
  const Interval interval{0.25, 0.5};
  EXPECT_TRUE(interval.Contains(0.25));
  EXPECT_TRUE(interval.Contains(0.5));
  EXPECT_FALSE(interval.Contains(0.2499));
  EXPECT_FALSE(interval.Contains(0.5001));
  EXPECT_FALSE(interval.Contains(std::nan("")));
}

// 1, ..., 5: mean 3, variance 2.5; the 0.975 quantile of four degrees of freedom is 2.7764451051977987 (R:
// qt(0.975, 4)).
TEST(StudentInterval, OfFiveNumbers) {
  Moments moments;
  for (const double x : {1.0, 2.0, 3.0, 4.0, 5.0}) moments.Add(x);
  const double half_width = 2.7764451051977987 * std::sqrt(2.5 / 5.0);
  EXPECT_NEAR(StudentInterval(moments).lower, 3.0 - half_width, 1e-9);
  EXPECT_NEAR(StudentInterval(moments).upper, 3.0 + half_width, 1e-9);
}

TEST(StudentInterval, OneNumberBoundsNothing) {
  Moments moments;
  moments.Add(1.0);
  EXPECT_TRUE(std::isinf(StudentInterval(moments).lower) && std::isinf(StudentInterval(moments).upper));
}

}  // namespace
}  // namespace rcme
