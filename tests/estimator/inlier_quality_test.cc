#include "estimator/inlier_quality.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "stats/constants.h"
#include "stats/distributions.h"
#include "stats/random.h"

namespace rcme {
namespace {

InlierScore MakeScore(const std::vector<double>& entropies) {
  InlierScore score;
  for (const double h : entropies) score.AddInlier(h);
  return score;
}

TEST(InlierScore, WelfordAgreesWithTwoPasses) {
  RandomStream rng({.seed = 1, .purpose = 120});
  for (const double offset : {0.0, -3.5, 1e6}) {
    std::vector<double> entropies(500);
    long double sum = 0.0L;
    for (double& h : entropies) sum += h = offset + 2.0 * rng.Normal();
    const long double mean = sum / 500.0L;
    long double sum_squares = 0.0L;
    for (const double h : entropies) sum_squares += (h - mean) * (h - mean);
    const InlierScore score = MakeScore(entropies);
    EXPECT_EQ(score.num_inliers, 500);
    EXPECT_NEAR(score.mean_entropy, static_cast<double>(mean), 1e-13 * (1.0 + std::abs(offset)));
    EXPECT_NEAR(score.sum_squares, static_cast<double>(sum_squares), 1e-9 * static_cast<double>(sum_squares));
  }
}

TEST(InlierScore, MeanOfNegativeEntropiesIsNegative) {
  EXPECT_DOUBLE_EQ(MakeScore({-4.0, -2.0, -3.0}).mean_entropy, -3.0);
}

TEST(ZStatistic, ByHand) {
  // Mean 2, s = 2 (n - 1 = 2), s / sqrt(3): Z = (2 - 1) sqrt(3) / 2.
  EXPECT_DOUBLE_EQ(ZStatistic(MakeScore({0.0, 2.0, 4.0}), 1.0), std::sqrt(3.0) / 2.0);
  EXPECT_DOUBLE_EQ(ZStatistic(MakeScore({0.0, 2.0, 4.0}), 3.0), -std::sqrt(3.0) / 2.0);
  EXPECT_EQ(ZStatistic(MakeScore({0.0, 2.0, 4.0}), 2.0), 0.0);
}

TEST(ZStatistic, WithoutInliersIsInfinite) {
  EXPECT_EQ(ZStatistic(InlierScore(), -3.53), kInfinity);
  EXPECT_EQ(ZStatistic(InlierScore(), 3.53), kInfinity) << "whatever mu is: an empty set is never good";
}

TEST(ZStatistic, OneInlierOrNoSpreadIsTheLimitOfSmallSpread) {
  for (const std::vector<double>& entropies : {std::vector<double>{1.0}, {1.0, 1.0, 1.0}}) {
    const InlierScore score = MakeScore(entropies);
    EXPECT_EQ(ZStatistic(score, 0.5), kInfinity);
    EXPECT_EQ(ZStatistic(score, 1.5), -kInfinity);
    EXPECT_EQ(ZStatistic(score, 1.0), -kInfinity) << "psi <= mu counts as good";
  }
}

TEST(ZStatistic, IsStandardNormalForIndependentEntropies) {
  // Only the formula's scale is under test: 20 000 sets of 100, variance of Z within 5 sigma of 99 / 97
  // (Student). Dividing by s^2 / sqrt(n) instead, as boost::math's z-test did, gives s-fold values:
  // variance 4.
  RandomStream rng({.seed = 1, .purpose = 121});
  double sum_squares = 0.0;
  constexpr int kSets = 20'000;
  for (int i = 0; i < kSets; ++i) {
    InlierScore score;
    for (int k = 0; k < 100; ++k) score.AddInlier(-1.0 + 0.5 * rng.Normal());
    const double z = ZStatistic(score, -1.0);
    sum_squares += z * z;
  }
  EXPECT_NEAR(sum_squares / kSets, 99.0 / 97.0, 5.0 * std::sqrt(2.0 / kSets));
}

TEST(IsBetter, LooksAtTheDecidingNumberAlone) {
  const InlierScore most{.num_inliers = 3, .mean_entropy = 2.0, .negative_log_likelihood = 2.0};
  const InlierScore least_entropy{.num_inliers = 2, .mean_entropy = 1.0, .negative_log_likelihood = 3.0};
  const InlierScore least_cost{.num_inliers = 1, .mean_entropy = 3.0, .negative_log_likelihood = 1.0};
  const std::vector<InlierScore> scores = {most, least_entropy, least_cost};
  const auto wins = [&](size_t k, DecidingScore decides) {
    for (size_t other = 0; other < scores.size(); ++other) {
      if (IsBetter(scores[k], scores[other], decides) != (other != k)) return false;
      if (IsBetter(scores[other], scores[k], decides)) return false;
    }
    return true;
  };
  EXPECT_TRUE(wins(0, DecidingScore::kNumInliers));
  EXPECT_TRUE(wins(1, FindDecidingScore(Selection::kMeanEntropy)));
  EXPECT_TRUE(wins(2, FindDecidingScore(Selection::kPredictiveLikelihood)));
}

TEST(PassesQualityTest, TheTwoReadingsDifferBetweenTheQuantiles) {
  const double quantile = NormalQuantile(0.95);  // 1.645
  for (const double z : {-kInfinity, -3.0, -1.645}) {
    EXPECT_TRUE(PassesQualityTest(z, quantile, QualityTest::kAsPrinted)) << z;
    EXPECT_TRUE(PassesQualityTest(z, quantile, QualityTest::kLevelAlpha)) << z;
  }
  for (const double z : {-1.644, 0.0, 1.644}) {
    EXPECT_TRUE(PassesQualityTest(z, quantile, QualityTest::kAsPrinted)) << z;
    EXPECT_FALSE(PassesQualityTest(z, quantile, QualityTest::kLevelAlpha)) << z;
  }
  for (const double z : {1.645, 3.0, kInfinity, std::nan("")}) {
    EXPECT_FALSE(PassesQualityTest(z, quantile, QualityTest::kAsPrinted)) << z;
    EXPECT_FALSE(PassesQualityTest(z, quantile, QualityTest::kLevelAlpha)) << z;
  }
}

}  // namespace
}  // namespace rcme
