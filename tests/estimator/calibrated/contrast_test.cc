#include "estimator/calibrated/contrast.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/random.h"

namespace rcme {
namespace {

// One match each: its probability and density in a mode.
Explanation Explaining(const std::vector<double>& probability, const std::vector<double>& density) {
  Explanation e;
  e.probability = probability;
  e.left_out_density = density;
  return e;
}

// Matches 0 to 2 are shared, 3 is of a, 4 and 5 of b, 6 of none. Densities of 1e12 backgrounds are right, of
// 0 wrong, so that the shares are (right + 1/2) / (3 + 1).
TEST(Contrast, OfAnExampleByHand) {
  constexpr double q = 1e-3, right = 1e12 * q;
  const Explanation a = Explaining({.9, .9, .9, .9, .1, .1, .1}, {2.0, 1.0, 4.0, right, 0.0, 0.0, 7.0});
  const Explanation b = Explaining({.9, .9, .9, .1, .9, .9, .1}, {1.0, 1.0, 2.0, 0.0, right, right, 9.0});
  const Contrast contrast = CompareModes(a, b, q);
  EXPECT_EQ(contrast.num_better_a, 3);  // 0, 2 and 3; match 1 is a tie
  EXPECT_EQ(contrast.num_better_b, 2);
  EXPECT_EQ(contrast.num_clearly_a, 1);
  EXPECT_EQ(contrast.num_clearly_b, 2);
  const double log2 = std::log(2.0);
  EXPECT_NEAR(contrast.shared, 2.0 * log2, 1e-12);
  // Terms log 2, 0, log 2 about their mean 2/3 log 2.
  EXPECT_NEAR(contrast.shared_variance, 2.0 / 3.0 * log2 * log2, 1e-12);
  const double share_a = 1.5 / 4.0, share_b = 2.5 / 4.0;
  const double of_a = std::log(share_a * 1e12 + 1.0 - share_a) + 2.0 * std::log(1.0 - share_a);
  const double of_b = 2.0 * std::log(share_b * 1e12 + 1.0 - share_b) + std::log(1.0 - share_b);
  EXPECT_NEAR(contrast.exclusive, of_a - of_b, 1e-9);
}

// Densities of a few backgrounds: the share of right matches of either mode by eight steps of expectation and
// maximisation from one half, with half a match of prior on either side.
TEST(Contrast, OfUnclearMatchesByHand) {
  constexpr double q = 0.1;
  const std::vector<double> d_a = {0.5, 0.2, 0.05, 0.02}, d_b = {0.1, 0.6, 0.3, 0.4};
  const Explanation a = Explaining({.9, .9, .1, .1}, d_a), b = Explaining({.1, .1, .9, .9}, d_b);
  const auto log_likelihood = [&](const std::vector<double>& densities) {
    double share = 0.5;
    for (int step = 0; step < 8; ++step) {
      double right = 0.5;
      for (const double d : densities) right += share * d / (share * d + (1.0 - share) * q);
      share = right / 5.0;
    }
    double sum = 0.0;
    for (const double d : densities) sum += std::log(share * d + (1.0 - share) * q);
    return sum;
  };
  EXPECT_NEAR(CompareModes(a, b, q).exclusive, log_likelihood(d_a) - log_likelihood(d_b), 1e-12);
}

TEST(Contrast, TurnsOverWithTheModes) {
  RandomStream rng({.seed = 1, .purpose = 2740});
  std::vector<double> p_a, p_b, d_a, d_b;
  for (int i = 0; i < 200; ++i) {
    p_a.push_back(rng.Uniform());
    p_b.push_back(rng.Uniform());
    d_a.push_back(rng.Uniform(0.01, 1.0));
    d_b.push_back(rng.Uniform(0.01, 1.0));
  }
  const Explanation a = Explaining(p_a, d_a), b = Explaining(p_b, d_b);
  const Contrast forth = CompareModes(a, b, 0.1), back = CompareModes(b, a, 0.1);
  ASSERT_GT(std::abs(forth.exclusive), 1e-3);
  EXPECT_NEAR(forth.exclusive, -back.exclusive, 1e-9);
  EXPECT_NEAR(forth.shared, -back.shared, 1e-9);
  EXPECT_NEAR(forth.shared_variance, back.shared_variance, 1e-9);
  ASSERT_NE(forth.num_better_a, forth.num_better_b);
  EXPECT_EQ(forth.num_better_a, back.num_better_b);
  EXPECT_EQ(forth.num_better_b, back.num_better_a);
}

TEST(Contrast, OfAModeWithItselfIsNothing) {
  const Explanation a = Explaining({.9, .2, .8}, {1.0, 2.0, 3.0});
  const Contrast contrast = CompareModes(a, a, 0.1);
  EXPECT_EQ(contrast.exclusive, 0.0);
  EXPECT_EQ(contrast.shared, 0.0);
  EXPECT_EQ(contrast.num_better_a, 0);
  EXPECT_EQ(contrast.num_better_b, 0);
}

TEST(Contrast, IsClearFromFiveNatsOn) {
  const double more = std::exp(kClearly + 1e-9), less = std::exp(kClearly - 1e-9);
  const Explanation a = Explaining({.9, .9, .9}, {more, less, more}),
                    b = Explaining({.9, .9, .1}, {1.0, 1.0, 1.0});
  EXPECT_EQ(CompareModes(a, b, 0.1).num_clearly_a, 2);
  EXPECT_EQ(CompareModes(b, a, 0.1).num_clearly_b, 2);
  EXPECT_EQ(CompareModes(b, a, 0.1).num_clearly_a, 0);
}

}  // namespace
}  // namespace rcme
