#include "stats/thresholds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stats/distributions.h"
#include "stats/random.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

TEST(AreaUnderCurve, KnownAnswer) {
  // By the definition, kernel by kernel:  python3 tests/known_answers/samples.py  (ties in and between the
  // samples)
  const AreaUnderCurve area = MeasureAreaUnderCurve({1, 2, 2, 3, 4, 4, 5, 7}, {2, 4, 5, 6, 6, 8, 9});
  EXPECT_NEAR(area.value, 0.776785714286, 1e-12);
  EXPECT_NEAR(area.standard_error, 0.128356301505, 1e-12);
  EXPECT_NEAR(area.interval.lower, 0.525211986147, 1e-11);
  EXPECT_EQ(area.interval.upper, 1.0);  // 1.028, kept to 1
}

TEST(AreaUnderCurve, IntervalCoversAsOftenAsItSays) {
  // Normal scores, m = n = 200, 4000 repetitions. AUC = Phi(shift / sqrt(2)); shift 0 is the null, whose
  // false-alarm rate this measures. Scores rounded to whole numbers have ties in every second pair.
  for (const double shift : {0.0, 1.0}) {
    CoverageCount covered, rounded_covered;
    double rounded_truth = 0.0;  // P(round(X + shift) > round(Y)) + P(=) / 2
    for (int i = -9; i <= 9; ++i) {
      const double p = NormalCdf(i + 0.5 - shift) - NormalCdf(i - 0.5 - shift);
      rounded_truth += p * 0.5 * (NormalCdf(i - 0.5) + NormalCdf(i + 0.5));
    }
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(shift), .purpose = 140});
    for (int repetition = 0; repetition < 4000; ++repetition) {
      std::vector<double> negatives(200), positives(200);
      for (double& x : negatives) x = rng.Normal();
      for (double& x : positives) x = shift + rng.Normal();
      covered.Add(
          MeasureAreaUnderCurve(negatives, positives).interval.Contains(NormalCdf(shift / std::sqrt(2.0))));
      for (double& x : negatives) x = std::round(x);
      for (double& x : positives) x = std::round(x);
      rounded_covered.Add(MeasureAreaUnderCurve(negatives, positives).interval.Contains(rounded_truth));
    }
    EXPECT_TRUE(covered.Admits(0.95)) << "shift " << shift << ": " << covered;
    EXPECT_TRUE(rounded_covered.Admits(0.95)) << "shift " << shift << ": " << rounded_covered;
    EXPECT_FALSE(covered.Admits(0.93)) << "no power";
    EXPECT_FALSE(covered.Admits(0.97)) << "no power";
    RecordProperty("coverage_" + std::to_string(static_cast<int>(shift)), std::to_string(covered.rate()));
  }
}

TEST(AreaUnderCurve, HasPower) {
  // A shift of 0.4 sigma (AUC 0.61), m = n = 200, is told from chance with power above 0.9.
  CoverageCount caught;
  RandomStream rng({.seed = 1, .purpose = 141});
  for (int repetition = 0; repetition < 1000; ++repetition) {
    std::vector<double> negatives(200), positives(200);
    for (double& x : negatives) x = rng.Normal();
    for (double& x : positives) x = 0.4 + rng.Normal();
    caught.Add(MeasureAreaUnderCurve(negatives, positives).interval.lower > 0.5);
  }
  EXPECT_GT(caught.interval().lower, 0.9) << caught;
}

TEST(AreaUnderCurve, PerfectSeparationIsNotCertainty) {
  // (0.025)^(1 / 3) for three pairs.
  const AreaUnderCurve perfect = MeasureAreaUnderCurve({1, 2, 3, 4}, {5, 6, 7});
  EXPECT_EQ(perfect.value, 1.0);
  EXPECT_NEAR(perfect.interval.lower, std::cbrt(0.025), 1e-14);
  EXPECT_EQ(perfect.interval.upper, 1.0);
  const AreaUnderCurve reversed = MeasureAreaUnderCurve({5, 6, 7}, {1, 2, 3, 4});
  EXPECT_EQ(reversed.value, 0.0);
  EXPECT_NEAR(reversed.interval.upper, 1.0 - std::cbrt(0.025), 1e-14);
  // Equal scores are chance.
  EXPECT_EQ(MeasureAreaUnderCurve({1, 1, 1}, {1, 1}).value, 0.5);
}

TEST(Roc, ByHandWithTies) {
  const std::vector<RocPoint> curve = RocCurve({1, 2, 2, 3}, {2, 3, 4, 4, 4});
  const double kInfinity = std::numeric_limits<double>::infinity();
  const RocPoint kExpected[] = {
      {kInfinity, 0.0, 0.0}, {4.0, 0.0, 0.6}, {3.0, 0.25, 0.8}, {2.0, 0.75, 1.0}, {1.0, 1.0, 1.0}};
  ASSERT_EQ(curve.size(), std::size(kExpected));
  for (size_t i = 0; i < curve.size(); ++i) {
    EXPECT_EQ(curve[i].threshold, kExpected[i].threshold);
    EXPECT_NEAR(curve[i].false_positive_rate, kExpected[i].false_positive_rate, 1e-15);
    EXPECT_NEAR(curve[i].true_positive_rate, kExpected[i].true_positive_rate, 1e-15);
  }
}

TEST(Roc, TrapezesUnderTheCurveAreTheAreaUnderIt) {
  RandomStream rng({.seed = 1, .purpose = 142});
  std::vector<double> negatives(300), positives(200);
  for (double& x : negatives) x = std::round(4.0 * rng.Normal());
  for (double& x : positives) x = std::round(4.0 * rng.Normal() + 3.0);
  const std::vector<RocPoint> curve = RocCurve(negatives, positives);
  double area = 0.0;
  for (size_t i = 1; i < curve.size(); ++i) {
    area += 0.5 * (curve[i].true_positive_rate + curve[i - 1].true_positive_rate) *
            (curve[i].false_positive_rate - curve[i - 1].false_positive_rate);
  }
  EXPECT_NEAR(area, MeasureAreaUnderCurve(negatives, positives).value, 1e-12);
  EXPECT_EQ(curve.back().false_positive_rate, 1.0);
  EXPECT_EQ(curve.back().true_positive_rate, 1.0);
}

TEST(RiskCoverage, ByHandWithTiesAndRefusals) {
  const double kRefused = -std::numeric_limits<double>::infinity();
  const std::vector<RiskCoveragePoint> curve =
      RiskCoverageCurve({{0.5, true}, {0.9, false}, {0.5, false}, {kRefused, true}, {0.7, false}});
  ASSERT_EQ(curve.size(), 4u);
  const double kCoverage[] = {0.2, 0.4, 0.8, 1.0}, kRisk[] = {0.0, 0.0, 0.25, 0.4};
  const double kThreshold[] = {0.9, 0.7, 0.5, kRefused};
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(curve[i].threshold, kThreshold[i]);
    EXPECT_DOUBLE_EQ(curve[i].coverage, kCoverage[i]);
    EXPECT_DOUBLE_EQ(curve[i].risk, kRisk[i]);
  }
  EXPECT_TRUE(RiskCoverageCurve({}).empty());
}

TEST(Thresholds, BadInput) {
  EXPECT_THROW(RocCurve({}, {1.0}), std::invalid_argument);
  EXPECT_THROW(MeasureAreaUnderCurve({1.0}, {}), std::invalid_argument);
  EXPECT_THROW(MeasureAreaUnderCurve({1.0, std::nan("")}, {1.0}), std::invalid_argument);
  EXPECT_THROW(RiskCoverageCurve({{std::nan(""), false}}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
