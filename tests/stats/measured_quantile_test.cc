#include "stats/measured_quantile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/distributions.h"
#include "stats/moments.h"
#include "stats/order_statistic.h"
#include "stats/random.h"
#include "stats/student_scales.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

// With the values 1..n the ends of the interval are the ranks themselves.
Interval RanksOfQuantile(int n, double p, double confidence) {
  std::vector<double> values(static_cast<size_t>(n));
  std::iota(values.rbegin(), values.rend(), 1.0);
  return MeasureQuantile(values, p, confidence).interval;
}

TEST(Quantile, IntervalHasItsCoverageForEveryLaw) {
  // Exactly: B ~ Binomial(n, p) values lie below the quantile of a continuous law, and the interval misses it
  // where B < lower or B >= upper. Each tail is at most alpha / 2 and the next order statistic inwards would
  // exceed it.
  for (const int n : {10, 57, 400}) {
    for (const double p : {0.05, 0.5, 0.9, 0.99}) {
      std::vector<double> below = {0.0};  // P(B < k)
      for (int k = 0; k <= n; ++k) {
        below.push_back(below.back() +
                        std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) +
                                 k * std::log(p) + (n - k) * std::log1p(-p)));
      }
      const Interval ranks = RanksOfQuantile(n, p, 0.95);
      if (std::isfinite(ranks.lower)) {
        EXPECT_LE(below[static_cast<size_t>(ranks.lower)], 0.025 + 1e-12);
      }
      const double next_lower = std::isfinite(ranks.lower) ? ranks.lower + 1.0 : 1.0;
      EXPECT_GT(below[static_cast<size_t>(next_lower)], 0.025) << "n = " << n << ", p = " << p;
      if (std::isfinite(ranks.upper)) {
        EXPECT_LE(1.0 - below[static_cast<size_t>(ranks.upper)], 0.025 + 1e-12);
      }
      const double next_upper = std::isfinite(ranks.upper) ? ranks.upper - 1.0 : n;
      EXPECT_GT(1.0 - below[static_cast<size_t>(next_upper)], 0.025) << "n = " << n << ", p = " << p;
    }
  }
}

TEST(Quantile, RanksByHand) {
  // The median of 10 values: the 2nd and the 9th, coverage 1 - 2 * 11 / 1024 = 0.979.
  const Interval ranks = RanksOfQuantile(10, 0.5, 0.95);
  EXPECT_EQ(ranks.lower, 2.0);
  EXPECT_EQ(ranks.upper, 9.0);
  // At 99 %: the 1st and the 10th, coverage 1 - 2 / 1024 = 0.998; the 2nd would leave out 1.07 %.
  EXPECT_EQ(RanksOfQuantile(10, 0.5, 0.99).lower, 1.0);
  EXPECT_EQ(RanksOfQuantile(10, 0.5, 0.99).upper, 10.0);
  EXPECT_EQ(RanksOfQuantile(10, 0.99, 0.95).upper, std::numeric_limits<double>::infinity());
  EXPECT_EQ(RanksOfQuantile(10, 0.01, 0.95).lower, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(MeasureQuantile({5.0, 1.0, 3.0, 4.0, 2.0}, 0.5).value, 3.0);
  EXPECT_EQ(MeasureQuantile({4.0, 1.0, 3.0, 2.0}, 0.75).value, 3.0);
}

TEST(Quantile, IntervalCoversAndStandardErrorIsTheSpreadOverRepetitions) {
  // Normals, n = 1000, 2000 repetitions; the true spread is sqrt(p (1 - p) / n) / density. The mean standard
  // error agrees to 6 % (the spread itself is known to 1.6 %).
  const struct { double p, quantile; } kCases[] = {{0.5, 0.0}, {0.95, 1.6448536269514722}};
  for (const auto& [p, truth] : kCases) {
    CoverageCount covered;
    Moments values, standard_errors;
    RandomStream rng({.seed = 1, .condition = static_cast<std::uint32_t>(100 * p), .purpose = 111});
    for (int repetition = 0; repetition < 2000; ++repetition) {
      std::vector<double> sample(1000);
      for (double& z : sample) z = rng.Normal();
      const MeasuredQuantile measured = MeasureQuantile(std::move(sample), p);
      covered.Add(measured.interval.Contains(truth));
      values.Add(measured.value);
      standard_errors.Add(measured.standard_error);
    }
    const double density = std::exp(-0.5 * truth * truth) / std::sqrt(2.0 * std::numbers::pi);
    const double spread = std::sqrt(p * (1.0 - p) / 1000.0) / density;
    EXPECT_GT(covered.interval().upper, 0.95) << covered;
    EXPECT_LT(covered.interval().lower, 0.955) << covered;
    EXPECT_NEAR(values.mean(), truth, 4.0 * spread / std::sqrt(2000.0) + 0.1 * spread);
    EXPECT_NEAR(standard_errors.mean(), spread, 0.06 * spread);
  }
}

TEST(Quantile, BadInput) {
  EXPECT_THROW(MeasureQuantile({}, 0.5), std::invalid_argument);
  EXPECT_THROW(MeasureQuantile({1.0, std::nan("")}, 0.5), std::invalid_argument);
  EXPECT_THROW(MeasureQuantile({1.0}, 0.0), std::invalid_argument);
  EXPECT_THROW(MeasureQuantile({1.0}, 0.5, 1.0), std::invalid_argument);
}

TEST(OrderStatistic, IsThatOfTheSortedList) {
  RandomStream rng({.seed = 1, .purpose = 9});
  std::vector<double> values;
  for (int i = 0; i < 37; ++i) values.push_back(rng.Uniform());
  std::vector<double> sorted = values;
  std::ranges::sort(sorted);
  for (const size_t rank : {0, 1, 18, 36}) EXPECT_EQ(ValueOfRank(rank, &values), sorted[rank]);
  EXPECT_EQ(ComputeQuantile(values, 0.0), sorted[0]);
  EXPECT_EQ(ComputeQuantile(values, 0.99), sorted[35]);  // rank 35.64
  EXPECT_EQ(ComputeQuantile(values, 1.0), sorted[36]);
  std::vector<double> none;
  EXPECT_TRUE(std::isnan(ComputeQuantile(none, 0.5)));
}

// Student's t itself: the share of |t| > 3 by the scales' normal laws against its closed form with one and
// two degrees of freedom, 1 - 2 atan(3) / pi and 1 - 3 / sqrt(11); times the scales' unit, which their median
// tells (the middle of 32 lies between two).
TEST(StudentScales, HaveVarianceOneAndStudentsTails) {
  for (const double dof : {1.0, 1.5, 2.0, 5.0, 100.0}) {
    double sum_squares = 0.0;
    const StudentScales made(dof);
    for (const double scale : made.scales()) sum_squares += scale * scale / 32.0;
    EXPECT_NEAR(sum_squares, 1.0, 1e-5) << dof;
  }
  const double beyond[] = {1.0 - 2.0 / std::numbers::pi * std::atan(3.0), 1.0 - 3.0 / std::sqrt(11.0)};
  for (const int dof : {1, 2}) {
    const std::vector<double> scales = StudentScales(dof).scales();
    const double median = std::sqrt(dof / ChiSquareQuantile(dof, 0.5));
    const double unit = 0.5 * (scales[15] + scales[16]) / median;
    double share = 0.0;
    for (const double scale : scales) share += 2.0 * NormalCdf(-3.0 * unit / scale) / 32.0;
    EXPECT_NEAR(share / beyond[dof - 1], 1.0, 0.05) << dof;
  }
  RandomStream rng({.seed = 1, .purpose = 10}), untouched({.seed = 1, .purpose = 10});
  EXPECT_EQ(StudentScales(0.0).Draw(rng), 1.0);
  EXPECT_EQ(rng.Uniform(), untouched.Uniform());  // normal noise draws what it always drew
}

}  // namespace
}  // namespace rcme
