#include "stats/conformal.h"

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <vector>

#include "stats/constants.h"
#include "stats/intervals.h"
#include "stats/random.h"

namespace rcme {
namespace {

std::vector<std::int64_t> OneEach(size_t n) {
  std::vector<std::int64_t> groups(n);
  std::iota(groups.begin(), groups.end(), 0);
  return groups;
}

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

// Two groups of weight 1/3 each: {1, 2, 3, 4} in quarters of it, {10} whole.
TEST(ConformalBound, WeighsGroupsAlike) {
  const std::vector<double> scores = {4, 10, 1, 3, 2};
  const std::vector<std::int64_t> groups = {7, 9, 7, 7, 7};
  EXPECT_EQ(ConformalBound(scores, groups, 1.0 / 6.0), 2.0);
  EXPECT_EQ(ConformalBound(scores, groups, 1.0 / 3.0), 4.0);
  EXPECT_EQ(ConformalBound(scores, groups, 0.34), 10.0);
  EXPECT_EQ(ConformalBound(scores, groups, 0.67), kInfinity);
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

// Groups whose level differs: a random score of a new group is covered as promised by the bound for groups;
// that for independent scores misses the promise, so that the test has power.
TEST(ConformalBound, CoversAScoreOfANewGroup) {
  RandomStream rng({.seed = 1, .purpose = 411});
  const int num_groups = 12, per_group = 20, repetitions = 4000;
  std::int64_t covered = 0, covered_as_if_independent = 0;
  for (int repetition = 0; repetition < repetitions; ++repetition) {
    std::vector<double> scores;
    std::vector<std::int64_t> groups;
    for (int group = 0; group < num_groups; ++group) {
      const double level = rng.Normal();
      for (int i = 0; i < per_group; ++i) {
        scores.push_back(level + 0.1 * rng.Normal());
        groups.push_back(group);
      }
    }
    const double next = rng.Normal() + 0.1 * rng.Normal();
    covered += next <= ConformalBound(scores, groups, 0.9);
    covered_as_if_independent += next <= ConformalBound(scores, OneEach(scores.size()), 0.9);
  }
  EXPECT_GE(ExactBinomialInterval(covered, repetitions, 0.999).upper, 0.9);
  EXPECT_LT(ExactBinomialInterval(covered_as_if_independent, repetitions, 0.999).upper, 0.9);
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
