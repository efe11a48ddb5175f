// Known answers:  /usr/bin/python3 tests/known_answers/population_rate.py
#include "stats/population_rate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/test_support/condition_laws.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

std::vector<ConditionCount> MakeCounts(const std::vector<int>& events, const std::vector<int>& trials) {
  std::vector<ConditionCount> conditions;
  for (size_t i = 0; i < events.size(); ++i)
    conditions.push_back({events[i], trials[trials.size() == 1 ? 0 : i]});
  return conditions;
}

struct PublishedRate {
  double value, lower, upper, lower_here, upper_here, correlation, effective_n;
};

void ExpectRate(const PopulationRate& rate, const PublishedRate& published) {
  EXPECT_NEAR(rate.value, published.value, 1e-9);
  EXPECT_NEAR(rate.interval.lower, published.lower, 1e-8);
  EXPECT_NEAR(rate.interval.upper, published.upper, 1e-8);
  EXPECT_NEAR(rate.of_these_conditions.lower, published.lower_here, 1e-8);
  EXPECT_NEAR(rate.of_these_conditions.upper, published.upper_here, 1e-8);
  EXPECT_NEAR(rate.intraclass_correlation, published.correlation, 1e-9);
  EXPECT_NEAR(rate.effective_n, published.effective_n, 1e-6);
}

TEST(PopulationRate, KnownAnswers) {
  ExpectRate(
      MeasurePopulationRate(MakeCounts({0, 0, 1, 5, 0, 60}, {60})),
      {0.1833333333, 0.0069636678, 0.6424525117, 0.1447213158, 0.2272455356, 0.9109436243, 5.5758620690});
  const std::vector<ConditionCount> unequal = MakeCounts({0, 0, 1, 5, 0, 6}, {60, 20, 30, 40, 50, 60});
  ExpectRate(MeasurePopulationRate(unequal), {0.0430555556, 0.0013647730, 0.2727010160, 0.0204550693,
                                              0.0786921058, 0.0522340112, 79.1660489251});
  ExpectRate(
      MeasurePopulationRate(unequal, ConditionWeights::kByTrials),
      {0.0461538462, 0.0003949798, 0.3046039573, 0.0240725838, 0.0792330326, 0.0522340112, 72.1376936317});
  ExpectRate(MeasurePopulationRate(MakeCounts({29, 31, 33, 27, 30, 30}, {60})),
             {0.5, 0.4559952856, 0.5440047144, 0.4471459191, 0.5528540809, -0.0124327240, 360.0});
  ExpectRate(
      MeasurePopulationRate(MakeCounts({60, 60, 60, 60, 59, 60, 12, 60}, {60})),
      {0.8979166667, 0.5156953811, 0.9986154745, 0.8672907466, 0.9235201174, 0.7793234240, 9.2170958289});
}

TEST(PopulationRate, OfNonEventsIsTheMirrorImage) {
  const std::vector<int> events = {3, 0, 17, 60, 2};
  std::vector<int> others;
  for (const int k : events) others.push_back(60 - k);
  const PopulationRate rate = MeasurePopulationRate(MakeCounts(events, {60}), ConditionWeights::kEqual, 0.9);
  const PopulationRate mirror =
      MeasurePopulationRate(MakeCounts(others, {60}), ConditionWeights::kEqual, 0.9);
  EXPECT_NEAR(rate.interval.lower, 1.0 - mirror.interval.upper, 1e-12);
  EXPECT_NEAR(rate.interval.upper, 1.0 - mirror.interval.lower, 1e-12);
}

// Without an event a condition counts as one trial: the exact interval of 0 of 6, however many trials it has.
TEST(PopulationRate, WithoutAnEvent) {
  for (const int n : {1, 60, 1'000'000}) {
    const PopulationRate none = MeasurePopulationRate(MakeCounts(std::vector<int>(6, 0), {n}));
    EXPECT_EQ(none.value, 0.0);
    EXPECT_EQ(none.interval.lower, 0.0);
    EXPECT_NEAR(none.interval.upper, ExactBinomialInterval(0, 6).upper, 1e-12);
    EXPECT_NEAR(none.of_these_conditions.upper, ExactBinomialInterval(0, 6 * n).upper, 1e-9);
    EXPECT_TRUE(std::isnan(none.effective_n));
    EXPECT_TRUE(std::isnan(none.intraclass_correlation));
    const PopulationRate all = MeasurePopulationRate(MakeCounts(std::vector<int>(6, n), {n}));
    EXPECT_EQ(all.interval.upper, 1.0);
    EXPECT_NEAR(all.interval.lower, 1.0 - none.interval.upper, 1e-12);
  }
}

TEST(PopulationRate, OneConditionTellsNothingOfOthers) {
  const PopulationRate one = MeasurePopulationRate(MakeCounts({7}, {60}));
  EXPECT_NEAR(one.value, 7.0 / 60.0, 1e-15);
  EXPECT_EQ(one.interval.lower, 0.0);
  EXPECT_EQ(one.interval.upper, 1.0);
  EXPECT_NEAR(one.of_these_conditions.upper, ExactBinomialInterval(7, 60).upper, 1e-10);
  EXPECT_TRUE(std::isnan(MeasurePopulationRate({}).value));
  EXPECT_EQ(MeasurePopulationRate(MakeCounts({0, 7, 0, 3}, {0, 60, 0, 60})).num_conditions, 2);
  EXPECT_THROW(MeasurePopulationRate(MakeCounts({7}, {6})), std::invalid_argument);
  EXPECT_THROW(MeasurePopulationRate(MakeCounts({-1}, {6})), std::invalid_argument);
}

// Of conditions with one trial each the rate is a binomial's, and the intervals agree.
TEST(PopulationRate, OfSingleTrialsIsNearlyExact) {
  std::vector<int> events(400, 0);
  std::fill(events.begin(), events.begin() + 60, 1);
  const PopulationRate rate = MeasurePopulationRate(MakeCounts(events, {1}));
  const Interval exact = ExactBinomialInterval(60, 400);
  EXPECT_NEAR(rate.interval.lower, exact.lower, 0.002);
  EXPECT_NEAR(rate.interval.upper, exact.upper, 0.002);
  EXPECT_TRUE(std::isnan(rate.intraclass_correlation));
}

TEST(PopulationRate, KnownDifference) {
  const int first[] = {3, 0, 10, 2, 0, 1, 4}, second[] = {0, 1, 2, 0, 0, 3, 5};
  std::vector<ConditionPair> pairs, swapped;
  for (int i = 0; i < 7; ++i) {
    pairs.push_back({first[i], second[i], 40});
    swapped.push_back({second[i], first[i], 40});
  }
  const PopulationDifference difference = MeasurePopulationDifference(pairs);
  EXPECT_NEAR(difference.value, 0.0321428571, 1e-9);
  EXPECT_NEAR(difference.interval.lower, -0.1333874158, 1e-8);
  EXPECT_NEAR(difference.interval.upper, 0.2506200148, 1e-8);
  EXPECT_NEAR(MeasurePopulationDifference(swapped).interval.upper, -difference.interval.lower, 1e-12);
  EXPECT_THROW(MeasurePopulationDifference(std::vector<ConditionPair>{{4, 3, 6}}), std::invalid_argument);
}

TEST(PopulationRate, KishEffectiveNumber) {
  EXPECT_NEAR(KishEffectiveNumber(std::vector<double>{2.0, 2.0, 2.0}), 3.0, 1e-15);
  EXPECT_NEAR(KishEffectiveNumber(std::vector<double>{1.0, 2.0, 3.0}), 36.0 / 14.0, 1e-15);
  EXPECT_TRUE(std::isnan(KishEffectiveNumber({})));
}

// Each cell: whether the coverage can lie between 0.93 and 0.97, in 1,500 repetitions; where it does, a test
// raises a false alarm at a rate of at most 1e-4. The exact interval of the pooled trials is caught in every
// cell but the last, where trials are independent.
TEST(PopulationRate, CoversThePopulationsRate) {
  struct Cell {
    int num_conditions;
    double p, rho;
  };
  const Cell cells[] = {{6, 0.2, 0.3},    {30, 0.05, 0.3}, {30, 0.5, 0.7},
                        {200, 0.05, 0.3}, {200, 0.2, 0.7}, {200, 0.2, 0.0}};
  std::uint32_t number = 0;
  for (const Cell& cell : cells) {
    SCOPED_TRACE(testing::Message() << cell.num_conditions << " conditions, rate " << cell.p);
    RandomStream rng({.seed = 1, .trial = number++, .purpose = 482});
    const RateLaw law(RateLaw::Shape::kBeta, cell.p, cell.rho);
    CoverageCount covered, as_independent;
    for (int repetition = 0; repetition < 1500; ++repetition) {
      const PopulationRate rate = MeasurePopulationRate(
          DrawConditions(law, std::vector<int>(static_cast<size_t>(cell.num_conditions), 60), rng));
      covered.Add(rate.interval.Contains(cell.p));
      as_independent.Add(rate.of_these_conditions.Contains(cell.p));
    }
    EXPECT_GT(covered.interval().upper, 0.93) << covered;
    EXPECT_LT(covered.interval().lower, 0.97) << covered;
    EXPECT_LT(as_independent.interval().upper, cell.rho > 0.0 ? 0.6 : 1.0) << as_independent;
  }
}

// The mean of these conditions' rates, which is another truth in each sample.
TEST(PopulationRate, CoversTheseConditionsRate) {
  RandomStream rng({.seed = 1, .purpose = 483});
  const RateLaw law(RateLaw::Shape::kBeta, 0.1, 0.5);
  CoverageCount covered;
  for (int repetition = 0; repetition < 1000; ++repetition) {
    double sum = 0.0;
    std::vector<ConditionCount> conditions;
    for (int i = 0; i < 20; ++i) {
      const double rate = law.Draw(rng);
      sum += rate;
      conditions.push_back({DrawEvents(60, rate, rng), 60});
    }
    covered.Add(MeasurePopulationRate(conditions).of_these_conditions.Contains(sum / 20.0));
  }
  EXPECT_GT(covered.interval().upper, 0.95) << covered;  // cautious, as the header says
}

}  // namespace
}  // namespace rcme
