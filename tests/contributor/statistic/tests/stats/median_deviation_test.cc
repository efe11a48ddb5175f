#include "stats/median_deviation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

// The first is the example of NIST's and Wikipedia's pages on it.
TEST(MedianDeviation, KnownAnswers) {
  EXPECT_EQ(MedianDeviation({1.0, 1.0, 2.0, 2.0, 4.0, 6.0, 9.0}), 1.0);
  EXPECT_EQ(MedianDeviation({4.0, 1.0, 2.0, 3.0}), 1.0);
  EXPECT_EQ(MedianDeviation({7.0}), 0.0);
  EXPECT_TRUE(std::isnan(MedianDeviation({})));
}

// Of normal numbers it tends to Phi^-1(3/4) sigma, with the asymptotic variance 1 / (16 n phi(Phi^-1(3/4))^2)
// at sigma = 1: n = 10^5, z-test at 1e-4. A value off by 2 % is seen.
TEST(MedianDeviation, OfNormalNumbersIsTheirQuartile) {
  constexpr int kN = 100'000;
  RandomStream rng({.seed = 1, .purpose = 9001});
  std::vector<double> values(kN);
  for (double& x : values) x = 2.0 * rng.Normal();
  const double quartile = NormalQuantile(0.75);
  const double density = std::exp(-0.5 * quartile * quartile) / std::sqrt(2.0 * M_PI);
  const double precision = 4.0 * density * std::sqrt(1.0 * kN), measured = MedianDeviation(values) / 2.0;
  EXPECT_LT(std::abs(measured - quartile) * precision, 3.9);
  EXPECT_GT(std::abs(measured - 1.02 * quartile) * precision, 3.9) << "no power";
}

}  // namespace
}  // namespace rcme
