#include "stats/consistency.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(NormalizedErrorSquared, ByHand) {
  // [[4, 1], [1, 3]]^-1 = [[3, -1], [-1, 4]] / 11; e = (1, 2): (3 - 2 - 2 + 16) / 11.
  const Eigen::Matrix2d covariance{{4.0, 1.0}, {1.0, 3.0}};
  EXPECT_NEAR(NormalizedErrorSquared(Eigen::Vector2d(1.0, 2.0), covariance), 15.0 / 11.0, 1e-15);
  EXPECT_EQ(NormalizedErrorSquared(Eigen::Vector2d(1.0, 2.0), Eigen::Matrix2d(Eigen::Matrix2d::Zero())),
            std::numeric_limits<double>::infinity());
}

TEST(Anees, BoundsAreTheKnownOnes) {
  // Bar-Shalom, Li & Kirubarajan (2001), section 5.4.2: 50 runs of 2 dof, chi2_100 at 2.5 % and 97.5 % over
  // 50 = [74.2, 129.6] / 50 = [1.5, 2.6]. More digits:
  //   python3 -c "from mpmath import *; F = lambda x: gammainc(50, 0, x / 2, regularized=True)
  //   print([findroot(lambda x: F(x) - p, g) / 50 for p, g in ((mpf('0.025'), 74.), (mpf('0.975'), 130.))])"
  const Interval bounds = AneesBounds(50, 2, 0.95);
  EXPECT_NEAR(bounds.lower, 1.48443854949847, 1e-12);
  EXPECT_NEAR(bounds.upper, 2.59122394371673, 1e-12);
  EXPECT_EQ(AneesBounds(0, 2).upper, std::numeric_limits<double>::infinity());
  // Many trials: 5 +- 1.96 sqrt(2 * 5 / n), far above the range of an int of n dof.
  const Interval narrow = AneesBounds(1'000'000'000, 5, 0.95);
  EXPECT_NEAR(narrow.lower, 5.0 - 1.959964e-4, 1e-8);
  EXPECT_NEAR(narrow.upper, 5.0 + 1.959964e-4, 1e-8);
}

TEST(Anees, FalseAlarmRateIsNominalAndPowerAgainstTwentyPercent) {
  // 50 trials of 5 dof, 20 000 repetitions at 5 %. Errors 20 % larger or smaller than claimed are caught with
  // power above 0.97 and 0.99.
  CoverageCount alarms, larger, smaller;
  RandomStream rng({.seed = 1, .purpose = 70});
  for (int repetition = 0; repetition < 20'000; ++repetition) {
    Anees consistent(5), large(5), small(5), second_half(5);
    for (int trial = 0; trial < 50; ++trial) {
      double nees = 0.0;
      for (int k = 0; k < 5; ++k) {
        const double z = rng.Normal();
        nees += z * z;
      }
      (trial < 20 ? consistent : second_half).Add(nees);
      large.Add(1.44 * nees);
      small.Add(0.64 * nees);
    }
    consistent.Merge(second_half);
    ASSERT_EQ(consistent.n(), 50);
    alarms.Add(!consistent.IsConsistent());
    larger.Add(!large.IsConsistent());
    smaller.Add(!small.IsConsistent());
  }
  EXPECT_TRUE(alarms.Admits(0.05)) << alarms;
  EXPECT_FALSE(alarms.Admits(0.06)) << "no power";
  EXPECT_FALSE(alarms.Admits(0.04)) << "no power";
  EXPECT_GT(larger.interval().lower, 0.97) << larger;
  EXPECT_GT(smaller.interval().lower, 0.99) << smaller;
  RecordProperty("false_alarm_rate", std::to_string(alarms.rate()));
}

TEST(Anees, BadNumbersAreNotConsistent) {
  for (const double bad : {std::numeric_limits<double>::infinity(), std::nan("")}) {
    Anees anees(2);
    for (int i = 0; i < 20; ++i) anees.Add(2.0);
    EXPECT_TRUE(anees.IsConsistent());
    anees.Add(bad);
    EXPECT_FALSE(anees.IsConsistent());
  }
  EXPECT_FALSE(Anees(2).IsConsistent()) << "no trials are no evidence";
}

}  // namespace
}  // namespace rcme
