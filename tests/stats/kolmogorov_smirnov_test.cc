#include "tests/test_support/kolmogorov_smirnov.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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

}  // namespace
}  // namespace rcme
