#include "tests/test_support/goodness_of_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/math/statistics/anderson_darling.hpp>
#include <cmath>
#include <limits>

#include "stats/distributions.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"
#include "tests/test_support/uniform_cdf.h"

namespace rcme {
namespace {

TEST(KolmogorovSmirnov, StatisticByHand) {
  // F_n of {0.1, 0.4, 0.7} against F(x) = x: farthest at 0.7, where F_n jumps to 1.
  EXPECT_NEAR(TestKolmogorovSmirnov({0.7, 0.1, 0.4}, UniformCdf).statistic, 0.3, 1e-15);
  // Below the step: F = 0.9 where F_n is still 0.
  EXPECT_NEAR(TestKolmogorovSmirnov({0.9, 0.95}, UniformCdf).statistic, 0.9, 1e-15);
  // Evenly in the middle of their cells: the least possible, 1 / (2 n).
  EXPECT_NEAR(TestKolmogorovSmirnov({0.125, 0.375, 0.625, 0.875}, UniformCdf).statistic, 0.125, 1e-15);
}

TEST(KolmogorovSmirnov, PValuesOfTheLimitLaw) {
  // Kolmogorov's tail 2 sum (-1)^(k-1) exp(-2 k^2 x^2) at x, by mpmath: python3 -c "from mpmath import *;
  //   print(2 * nsum(lambda k: (-1)**(int(k) - 1) * exp(-2 * k * k * mpf('1.0')**2), [1, 60]))"
  // A sample of n points i / n - shift, n large, has exactly the distance that was asked for.
  constexpr int kPoints = 1'000'000;
  const double root = 1000.0 + 0.12 + 0.11 / 1000.0;  // Stephens' correction
  for (const auto& [x, tail] : {std::pair{0.5, 0.963945243665},
                                {1.0, 0.269999671677},
                                {1.3580986393225505, 0.05},
                                {1.6276236115189504, 0.01}}) {
    std::vector<double> sample(kPoints);
    for (int i = 0; i < kPoints; ++i) sample[static_cast<size_t>(i)] = (i + 1.0) / kPoints - x / root;
    const KolmogorovSmirnov test = TestKolmogorovSmirnov(sample, UniformCdf);
    EXPECT_NEAR(test.statistic, x / root, 1e-12);
    EXPECT_NEAR(test.p_value, tail, 1e-8);
  }
}

TEST(KolmogorovSmirnov, FalseAlarmRateIsNominal) {
  // 20 000 tests of true uniforms per sample size, at 5 % and at 1 %: each rate within its exact interval
  // (false alarm of this test 4 * 1e-4). Catches a size of 0.056 instead of 0.05 with power above 0.5 and of
  // 0.06 with power above 0.99: without Stephens' correction the size at n = 20 would be 0.04.
  for (const int n : {20, 200}) {
    CoverageCount five, one;
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(n), .purpose = 30});
    for (int repetition = 0; repetition < 20'000; ++repetition) {
      std::vector<double> sample(static_cast<size_t>(n));
      for (double& u : sample) u = rng.Uniform();
      const double p = TestKolmogorovSmirnov(std::move(sample), UniformCdf).p_value;
      five.Add(p <= 0.05);
      one.Add(p <= 0.01);
    }
    EXPECT_TRUE(five.Admits(0.05)) << "n = " << n << ": " << five;
    EXPECT_TRUE(one.Admits(0.01)) << "n = " << n << ": " << one;
    EXPECT_FALSE(five.Admits(0.06)) << "no power";
    EXPECT_FALSE(five.Admits(0.04)) << "no power";
  }
}

TEST(KolmogorovSmirnov, HasPower) {
  // Normals whose sigma is off by 25 %, n = 1000: rejected at 1 % in more than 9 of 10 samples; whose mean is
  // off by 0.2 sigma likewise.
  CoverageCount wide, shifted;
  RandomStream rng({.seed = 1, .purpose = 31});
  for (int repetition = 0; repetition < 300; ++repetition) {
    std::vector<double> sample(1000);
    for (double& z : sample) z = rng.Normal();
    std::vector<double> scaled = sample, moved = sample;
    for (double& z : scaled) z *= 1.25;
    for (double& z : moved) z += 0.2;
    wide.Add(TestKolmogorovSmirnov(scaled, NormalCdf).p_value <= 0.01);
    shifted.Add(TestKolmogorovSmirnov(moved, NormalCdf).p_value <= 0.01);
  }
  EXPECT_GT(wide.interval().lower, 0.9) << wide;
  EXPECT_GT(shifted.interval().lower, 0.9) << shifted;
}

TEST(AndersonDarling, StatisticByHand) {
  // n = 1: -1 - ln(u (1 - u)). n = 2, {0.2, 0.6}: -2 - (ln(0.2 * 0.4) + 3 ln(0.6 * 0.8)) / 2.
  EXPECT_NEAR(TestAndersonDarling({0.3}, UniformCdf).statistic, -1.0 - std::log(0.21), 1e-14);
  EXPECT_NEAR(TestAndersonDarling({0.6, 0.2}, UniformCdf).statistic,
              -2.0 - 0.5 * (std::log(0.08) + 3.0 * std::log(0.48)), 1e-14);
}

TEST(AndersonDarling, StatisticIsBoosts) {
  RandomStream rng({.seed = 1, .purpose = 32});
  std::vector<double> sample(500);
  for (double& x : sample) x = 0.3 + 1.1 * rng.Normal();
  std::sort(sample.begin(), sample.end());
  EXPECT_NEAR(TestAndersonDarling(sample, NormalCdf).statistic,
              boost::math::statistics::anderson_darling_normality_statistic(sample, 0.0, 1.0), 1e-9);
}

TEST(AndersonDarling, TailOfTheLimitLaw) {
  // By Imhof's integral:  python3 tests/known_answers/anderson_darling.py
  const std::pair<double, double> kKnown[] = {
      {0.2, 0.9904125472},      {0.5, 0.7468143735},   {1.0, 0.3572666732}, {2.0, 0.0918367749},
      {2.492367, 0.0500000097}, {3.857, 0.0102411532}, {6.0, 0.0009674519}, {10.0, 0.0000138150}};
  for (const auto& [z, tail] : kKnown)
    EXPECT_NEAR(AndersonDarlingTail(z, 1LL << 60), tail, 2e-9) << "z = " << z;
  EXPECT_EQ(AndersonDarlingTail(0.0, 100), 1.0);
  EXPECT_LT(AndersonDarlingTail(40.0, 1LL << 60), 1e-15);
}

TEST(AndersonDarling, TailOfFewNumbers) {
  // By simulation, 6 million samples each:  /usr/bin/python3 tests/known_answers/anderson_darling_finite.py
  // Within four standard errors of the simulation (at most 8e-4) and 1e-4. The limit law alone is off by up
  // to 0.009.
  const struct {
    int n;
    double z, tail;
  } kKnown[] = {{5, 0.3, 0.937271},  {5, 0.6, 0.638894},  {5, 1.0, 0.352753},  {5, 1.6, 0.155579},
                {5, 2.5, 0.051942},  {5, 3.9, 0.010679},  {8, 0.3, 0.936931},  {8, 0.6, 0.642541},
                {8, 1.0, 0.354413},  {8, 1.6, 0.154835},  {8, 2.5, 0.050935},  {8, 3.9, 0.010328},
                {20, 0.3, 0.937473}, {20, 0.6, 0.645741}, {20, 1.0, 0.356025}, {20, 1.6, 0.154521},
                {20, 2.5, 0.049979}, {20, 3.9, 0.009931}};
  double worst_of_limit = 0.0;
  for (const auto& known : kKnown) {
    const double standard_error = std::sqrt(known.tail * (1.0 - known.tail) / 6e6);
    EXPECT_NEAR(AndersonDarlingTail(known.z, known.n), known.tail, 4.0 * standard_error + 1e-4)
        << "n = " << known.n << ", z = " << known.z;
    worst_of_limit = std::max(worst_of_limit, std::abs(AndersonDarlingTail(known.z, 1LL << 60) - known.tail));
  }
  EXPECT_GT(worst_of_limit, 0.005) << "no power";
}

TEST(AndersonDarling, FalseAlarmRateIsNominal) {
  for (const int n : {5, 20, 200}) {
    CoverageCount half, five, one;
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(n), .purpose = 33});
    for (int repetition = 0; repetition < 20'000; ++repetition) {
      std::vector<double> sample(static_cast<size_t>(n));
      for (double& u : sample) u = rng.Uniform();
      const double p = TestAndersonDarling(sample, UniformCdf).p_value;
      half.Add(p <= 0.5);
      five.Add(p <= 0.05);
      one.Add(p <= 0.01);
    }
    EXPECT_TRUE(half.Admits(0.5)) << "n = " << n << ": " << half;
    EXPECT_TRUE(five.Admits(0.05)) << "n = " << n << ": " << five;
    EXPECT_TRUE(one.Admits(0.01)) << "n = " << n << ": " << one;
    EXPECT_FALSE(five.Admits(0.06)) << "no power";
    EXPECT_FALSE(five.Admits(0.04)) << "no power";
    RecordProperty("size_n" + std::to_string(n), std::to_string(five.rate()));
  }
}

TEST(AndersonDarling, HasPowerInTheTailsWhereKolmogorovSmirnovHasLess) {
  // Normals whose sigma is off by 25 %, n = 500, at 1 %.
  CoverageCount anderson_darling, kolmogorov_smirnov;
  RandomStream rng({.seed = 1, .purpose = 34});
  for (int repetition = 0; repetition < 500; ++repetition) {
    std::vector<double> sample(500);
    for (double& z : sample) z = 1.25 * rng.Normal();
    anderson_darling.Add(TestAndersonDarling(sample, NormalCdf).p_value <= 0.01);
    kolmogorov_smirnov.Add(TestKolmogorovSmirnov(sample, NormalCdf).p_value <= 0.01);
  }
  EXPECT_GT(anderson_darling.interval().lower, 0.9) << anderson_darling;
  EXPECT_LT(kolmogorov_smirnov.interval().upper, anderson_darling.interval().lower) << kolmogorov_smirnov;
}

TEST(AndersonDarling, ImpossibleNumbersAreRejected) {
  for (const double impossible : {-1.0, 2.0, std::nan("")}) {
    const AndersonDarling test = TestAndersonDarling(
        {0.5, impossible, 0.25}, [](double x) { return std::isnan(x) ? x : UniformCdf(x); });
    EXPECT_EQ(test.statistic, std::numeric_limits<double>::infinity());
    EXPECT_EQ(test.p_value, 0.0);
  }
  EXPECT_EQ(TestAndersonDarling({}, UniformCdf).p_value, 1.0);
}

}  // namespace
}  // namespace rcme
