#include "stats/thresholds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stats/area_under_curve.h"
#include "stats/constants.h"
#include "stats/random.h"

namespace rcme {
namespace {

TEST(Roc, ByHandWithTies) {
  const std::vector<RocPoint> curve = RocCurve({1, 2, 2, 3}, {2, 3, 4, 4, 4});
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
  // Rounded scores have many ties; in the second round a quarter of either kind is infinite, both ways.
  for (const double largest : {100.0, 5.0}) {
    RandomStream rng({.seed = 1, .purpose = 142});
    std::vector<double> negatives(300), positives(200);
    const auto score = [&](double mean) {
      const double x = std::round(4.0 * rng.Normal() + mean);
      return std::abs(x) > largest ? std::copysign(std::numeric_limits<double>::infinity(), x) : x;
    };
    for (double& x : negatives) x = score(0.0);
    for (double& x : positives) x = score(3.0);
    const std::vector<RocPoint> curve = RocCurve(negatives, positives);
    double area = 0.0;
    for (size_t i = 1; i < curve.size(); ++i) {
      area += 0.5 * (curve[i].true_positive_rate + curve[i - 1].true_positive_rate) *
              (curve[i].false_positive_rate - curve[i - 1].false_positive_rate);
    }
    EXPECT_NEAR(area, MeasureAreaUnderCurve(negatives, positives).value, 1e-12);
    EXPECT_EQ(curve.front().true_positive_rate, 0.0);
    EXPECT_EQ(curve.back().false_positive_rate, 1.0);
    EXPECT_EQ(curve.back().true_positive_rate, 1.0);
  }
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
  EXPECT_THROW(RocCurve({1.0, std::nan("")}, {1.0}), std::invalid_argument);
  EXPECT_THROW(RiskCoverageCurve({{std::nan(""), false}}), std::invalid_argument);
}

}  // namespace
}  // namespace rcme
