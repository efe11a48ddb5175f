#include "stats/risk_coverage_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "stats/moments.h"
#include "stats/random.h"
#include "stats/thresholds.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

// By all orders of the ties:  /usr/bin/python3 tests/known_answers/forecasts.py
TEST(RiskCoverageArea, KnownAnswer) {
  const std::vector<ClusteredOutcome> outcomes = {{9, false, 0}, {8, false, 1}, {8, true, 2},  {5, false, 3},
                                                  {5, true, 4},  {5, true, 5},  {2, false, 6}, {1, true, 7}};
  EXPECT_NEAR(MeasureRiskCoverageArea(outcomes).value, 0.361904761905, 1e-12);
}

TEST(RiskCoverageArea, IsTheMeanOfTheCurveWhereNoScoresAreEqual) {
  RandomStream rng({.seed = 1, .purpose = 440});
  std::vector<ClusteredOutcome> outcomes;
  std::vector<ScoredOutcome> scored;
  for (int i = 0; i < 500; ++i) {
    outcomes.push_back({rng.Uniform(), rng.Uniform() < 0.2, i});
    scored.push_back({outcomes.back().score, outcomes.back().failed});
  }
  double mean = 0.0;
  for (const RiskCoveragePoint& point : RiskCoverageCurve(scored)) mean += point.risk / 500.0;
  EXPECT_NEAR(MeasureRiskCoverageArea(outcomes).value, mean, 1e-13);
}

// Failures at rate a u, u the rank from the surest on: the area is a / 4. Failures at one rate: that rate.
// Among scores that are all equal too, whose outcomes are then the only chance. 2,000 repetitions of 400: the
// intervals cover, the standard errors are the spread to 8 %.
TEST(RiskCoverageArea, CoversClosedForms) {
  const struct {
    double (*score)(double u);
    double (*rate)(double u);
    double area;
  } kCases[] = {{[](double u) { return -u; }, [](double u) { return 0.8 * u; }, 0.2},
                {[](double u) { return -u; }, [](double) { return 0.1; }, 0.1},
                {[](double) { return 1.0; }, [](double u) { return 0.8 * u; }, 0.4},
                {[](double u) { return -std::floor(5.0 * u); }, [](double) { return 0.1; }, 0.1}};
  for (std::uint32_t c = 0; c < std::size(kCases); ++c) {
    RandomStream rng({.seed = 1, .condition = c, .purpose = 441});
    CoverageCount covered;
    Moments areas, standard_errors;
    for (int repetition = 0; repetition < 2000; ++repetition) {
      std::vector<ClusteredOutcome> outcomes;
      for (int i = 0; i < 400; ++i) {
        const double u = rng.Uniform();
        outcomes.push_back({kCases[c].score(u), rng.Uniform() < kCases[c].rate(u), i});
      }
      const ClusteredEstimate area = MeasureRiskCoverageArea(outcomes);
      covered.Add(area.interval.Contains(kCases[c].area));
      areas.Add(area.value);
      standard_errors.Add(area.standard_error);
    }
    const double spread = std::sqrt(areas.variance());
    EXPECT_GT(covered.interval().upper, 0.95) << c << ": " << covered;
    EXPECT_GT(covered.rate(), 0.93) << c << ": " << covered;
    EXPECT_NEAR(areas.mean(), kCases[c].area, 4.0 * areas.standard_error()) << c;
    EXPECT_NEAR(standard_errors.mean(), spread, 0.08 * spread) << c;
  }
}

// Failures of 200 or 1,000 trials are few, and their scores are lower by `apart` standard deviations; the
// area is that of 400,000 trials. Of 600 repetitions with a failure at least 0.91 are covered, which
// fails with a probability of 5e-4 at a coverage of 0.94. With C - 1 degrees of freedom one of the cases
// fails.
TEST(RiskCoverageArea, CoversWhereFewFail) {
  const struct {
    int n;
    double rate, apart;
  } kCases[] = {{200, 0.01, 1.5}, {200, 0.05, 1.5}, {1000, 0.01, 1.5}, {200, 0.98, 1.5}};
  for (std::uint32_t c = 0; c < std::size(kCases); ++c) {
    RandomStream rng({.seed = 1, .condition = c, .purpose = 443});
    const auto draw = [&](int n) {
      std::vector<ClusteredOutcome> outcomes;
      for (int i = 0; i < n; ++i) {
        const bool failed = rng.Uniform() < kCases[c].rate;
        outcomes.push_back({rng.Normal() - (failed ? kCases[c].apart : 0.0), failed, i});
      }
      return outcomes;
    };
    const double area = MeasureRiskCoverageArea(draw(400'000)).value;
    CoverageCount covered;
    for (int repetition = 0; repetition < 600; ++repetition) {
      const std::vector<ClusteredOutcome> outcomes = draw(kCases[c].n);
      if (std::ranges::none_of(outcomes, &ClusteredOutcome::failed)) continue;
      covered.Add(MeasureRiskCoverageArea(outcomes).interval.Contains(area));
    }
    EXPECT_GT(covered.rate(), 0.91) << c << ": " << covered;
  }
}

// Each trial four times, as one scene, adds nothing (ties change the area itself a little).
TEST(RiskCoverageArea, CopiesInAClusterAddNothing) {
  RandomStream rng({.seed = 1, .purpose = 442});
  std::vector<ClusteredOutcome> once, copies;
  for (int i = 0; i < 300; ++i) {
    const double u = rng.Uniform();
    once.push_back({-u, rng.Uniform() < u, i});
    copies.insert(copies.end(), 4, once.back());
  }
  const ClusteredEstimate single = MeasureRiskCoverageArea(once), repeated = MeasureRiskCoverageArea(copies);
  EXPECT_NEAR(repeated.standard_error, single.standard_error, 0.03 * single.standard_error);
  EXPECT_EQ(repeated.num_clusters, 300);
}

TEST(RiskCoverageArea, EndsOfTheMatter) {
  std::vector<ClusteredOutcome> good;
  for (int i = 0; i < 50; ++i)
    good.push_back({i == 0 ? -std::numeric_limits<double>::infinity() : i, false, i});
  const ClusteredEstimate none = MeasureRiskCoverageArea(good);
  EXPECT_EQ(none.value, 0.0);
  EXPECT_EQ(none.interval.lower, 0.0);
  const double rate = 1.0 - std::pow(0.025, 1.0 / 50.0);
  EXPECT_NEAR(none.interval.upper, rate * (1.0 - std::log(rate)), 1e-12);
  std::vector<ClusteredOutcome> bad = good;
  for (ClusteredOutcome& outcome : bad) outcome.failed = true;
  const ClusteredEstimate all = MeasureRiskCoverageArea(bad);
  EXPECT_NEAR(all.value, 1.0, 1e-12);
  EXPECT_NEAR(all.interval.lower, 1.0 - rate * (1.0 - std::log(rate)), 1e-12);
  EXPECT_EQ(all.interval.upper, 1.0);
  const ClusteredEstimate one = MeasureRiskCoverageArea(std::vector<ClusteredOutcome>{{1.0, true, 0}});
  EXPECT_EQ(one.value, 1.0);
  EXPECT_EQ(one.interval.lower, 0.0);
  EXPECT_EQ(one.interval.upper, 1.0);
  EXPECT_THROW(MeasureRiskCoverageArea({}), std::invalid_argument);
  EXPECT_THROW(MeasureRiskCoverageArea(std::vector<ClusteredOutcome>{{std::nan(""), true, 0}}),
               std::invalid_argument);
}

}  // namespace
}  // namespace rcme
