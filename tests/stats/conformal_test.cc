#include "stats/conformal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

std::vector<double> OneEach(size_t n) { return std::vector<double>(n, 1.0); }

// k = ceil((n + 1) level) by hand.
TEST(ConformalBound, IsAnOrderStatistic) {
  std::vector<double> scores(19);
  std::iota(scores.begin(), scores.end(), 1.0);
  EXPECT_EQ(ConformalBound(scores, OneEach(19), 0.95), 19.0);
  EXPECT_EQ(ConformalBound(scores, OneEach(19), 0.9), 18.0);
  EXPECT_EQ(ConformalBound(scores, OneEach(19), 0.5), 10.0);
  scores.pop_back();
  EXPECT_EQ(ConformalBound(scores, OneEach(18), 0.95), kInfinity);
  EXPECT_EQ(ConformalBound({}, {}, 0.95), kInfinity);
}

// Two groups, {1, 2, 3, 4} and {10}, and level 1/3: at most 2/3 * 2 - 1/3 = 1 of a group may lie beyond, the
// whole second one; at level 1/2, 1/2.
TEST(ConformalBound, CountsGroups) {
  const std::vector<double> scores = {4, 10, 1, 3, 2}, shares = {0.25, 1.0, 0.25, 0.25, 0.25};
  EXPECT_EQ(ConformalBound(scores, shares, 1.0 / 3.0), 4.0);
  EXPECT_EQ(ConformalBound(scores, shares, 0.25), 3.0);  // 1.25 beyond
  EXPECT_EQ(ConformalBound(scores, shares, 0.5), 10.0);
  EXPECT_EQ(ConformalBound(scores, shares, 0.67), kInfinity);
}

// The scores of one stratum, half a group's problems each: A = 3 of six groups, and level .5 lets 1 lie
// beyond.
TEST(ConformalBound, OfAPartOfEachGroup) {
  const std::vector<double> scores = {1, 2, 3, 4, 5, 6}, shares(6, 0.5);
  EXPECT_EQ(ConformalBound(scores, shares, 0.5), 4.0);
  EXPECT_EQ(ConformalBound(scores, shares, 0.75), 6.0);  // none
  EXPECT_EQ(ConformalBound(scores, shares, 0.8), kInfinity);
}

TEST(ConformalBound, NeedsSoManyGroups) {
  EXPECT_EQ(FewestGroupsForBound(0.95), 19);
  EXPECT_EQ(FewestGroupsForBound(0.9), 9);
  EXPECT_EQ(FewestGroupsForBound(0.99), 99);
  for (const double level : {0.8, 0.9, 0.95, 0.98}) {
    const auto n = static_cast<size_t>(FewestGroupsForBound(level));
    EXPECT_LT(ConformalBound(std::vector<double>(n, 1.0), OneEach(n), level), kInfinity) << level;
    EXPECT_EQ(ConformalBound(std::vector<double>(n - 1, 1.0), OneEach(n - 1), level), kInfinity) << level;
  }
}

TEST(ConformalBound, RefusesWhatIsNone) {
  const std::vector<double> scores = {1.0};
  EXPECT_THROW(ConformalBound(scores, {}, 0.9), std::invalid_argument);
  EXPECT_THROW(ConformalBound(scores, std::vector<double>{0.0}, 0.9), std::invalid_argument);
  EXPECT_THROW(ConformalBound(scores, std::vector<double>{1.5}, 0.9), std::invalid_argument);
  EXPECT_THROW(ConformalBound(scores, OneEach(1), 1.0), std::invalid_argument);
  EXPECT_THROW(FewestGroupsForBound(0.0), std::invalid_argument);
}

// The mean over calibrations of the coverage is (k of n + 1): between level and level + 1 / (n + 1). 20,000
// calibrations; a wrong rank by one is 1 / 51 = .0196 off, 12 standard errors.
TEST(ConformalBound, CoversTheNextScore) {
  RandomStream rng({.seed = 1, .purpose = 410});
  const int n = 50, repetitions = 20000;
  std::int64_t covered = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<double> scores(n);
    for (double& score : scores) score = -std::log(1.0 - rng.Uniform());
    covered += -std::log(1.0 - rng.Uniform()) <= ConformalBound(scores, OneEach(n), 0.95);
  }
  const Interval rate = ExactBinomialInterval(covered, repetitions, 0.999);
  EXPECT_TRUE(rate.Contains(49.0 / 51.0)) << rate.lower << " " << rate.upper;
}

// Groups whose level differs, and that give more or fewer scores (the others are refused) the higher it is:
// of the scores of a new group at most the promised share lies beyond, on average, as the bound for
// independent scores does not have it.
TEST(ConformalBound, HoldsForANewGroup) {
  RandomStream rng({.seed = 1, .purpose = 411});
  const int num_groups = 12, per_group = 20, repetitions = 4000;
  double given = 0.0, beyond = 0.0, beyond_as_if_independent = 0.0;
  const auto draw = [&] {
    std::vector<double> scores;
    const double level = rng.Normal();
    for (int i = 0; i < per_group; ++i) {
      const double score = level + 0.1 * rng.Normal();
      if (rng.Uniform() < (level > 0.5 ? 1.0 : 0.5)) scores.push_back(score);
    }
    return scores;
  };
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<double> scores;
    for (int group = 0; group < num_groups; ++group) {
      const std::vector<double> more = draw();
      scores.insert(scores.end(), more.begin(), more.end());
    }
    const double bound = ConformalBound(scores, std::vector<double>(scores.size(), 1.0 / per_group), 0.8);
    const double independent = ConformalBound(scores, OneEach(scores.size()), 0.8);
    for (const double score : draw()) {
      given += 1.0;
      beyond += score > bound;
      beyond_as_if_independent += score > independent;
    }
  }
  // 4,000 groups: the standard error of the share is at most .4 / sqrt(4000) = .006.
  EXPECT_LE(beyond / given, 0.2 + 0.018);
  EXPECT_GE(beyond_as_if_independent / given, 0.2 + 0.018);
}

TEST(ConformalPValue, CountsWhatIsAsGreat) {
  const std::vector<double> reference = {1, 2, 2, 3};
  EXPECT_DOUBLE_EQ(ConformalPValue(reference, 4), 0.2);
  EXPECT_DOUBLE_EQ(ConformalPValue(reference, 2), 0.8);
  EXPECT_DOUBLE_EQ(ConformalPValue(reference, 0), 1.0);
  EXPECT_DOUBLE_EQ(ConformalPValue({}, 0), 1.0);
}

}  // namespace
}  // namespace rcme
