#include "stats/beta_binomial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <vector>

#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

TEST(BetaBinomialCdf, IsUniformForAUniformShare) {
  for (const std::int64_t n : {1, 7, 100})
    for (std::int64_t x = 0; x <= n; ++x)
      EXPECT_NEAR(BetaBinomialCdf(x, n, 1.0, 1.0), static_cast<double>(x + 1) / static_cast<double>(n + 1),
                  1e-11);
  EXPECT_EQ(BetaBinomialCdf(-1, 5, 2.0, 3.0), 0.0);
  EXPECT_EQ(BetaBinomialCdf(5, 5, 2.0, 3.0), 1.0);
  EXPECT_EQ(BetaBinomialCdf(0, 0, 2.0, 3.0), 1.0);
}

// The integral of the binomial's over the law of its share.
TEST(BetaBinomialCdf, IsTheMeanOfBinomials) {
  const double a = 19.0, b = 2.5;
  const double log_norm = std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b);
  for (const std::int64_t x : {10, 20, 28}) {
    double sum = 0.0;
    constexpr int kSteps = 20000;
    for (int i = 0; i < kSteps; ++i) {
      const double p = (i + 0.5) / kSteps;
      const double density = std::exp(log_norm + (a - 1.0) * std::log(p) + (b - 1.0) * std::log1p(-p));
      sum += BinomialCdf(x, 30, p) * density / kSteps;
    }
    EXPECT_NEAR(BetaBinomialCdf(x, 30, a, b), sum, 1e-6) << x;
  }
}

// The 18-th of 19 scores, and how many of 30 new ones it holds.
TEST(BetaBinomialCdf, IsTheLawOfTheNumberThatABoundHolds) {
  constexpr int kNumDrawn = 20000;
  int num_at_most = 0;
  RandomStream rng({.seed = 1, .purpose = 440});
  for (int i = 0; i < kNumDrawn; ++i) {
    std::vector<double> scores(19);
    for (double& score : scores) score = rng.Uniform();
    std::ranges::sort(scores);
    int num_held = 0;
    for (int j = 0; j < 30; ++j) num_held += rng.Uniform() <= scores[17];
    num_at_most += num_held <= 24;
  }
  const double expected = BetaBinomialCdf(24, 30, 18.0, 2.0);
  EXPECT_NEAR(static_cast<double>(num_at_most) / kNumDrawn, expected,
              4.0 * std::sqrt(expected * (1.0 - expected) / kNumDrawn));
}

TEST(BetaBinomialCdf, RefusesWhatIsNoLaw) {
  EXPECT_THROW(BetaBinomialCdf(1, 2, 0.0, 1.0), std::invalid_argument);
  EXPECT_THROW(BetaBinomialCdf(1, 2, 1.0, std::numeric_limits<double>::quiet_NaN()), std::invalid_argument);
  EXPECT_THROW(BetaBinomialCdf(1, -2, 1.0, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
