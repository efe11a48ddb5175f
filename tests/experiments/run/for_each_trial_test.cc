#include "experiments/run/for_each_trial.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <set>
#include <stdexcept>

#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;  // condition, trial

// Ranges of one condition with a gap, one that is empty, and another condition: each trial once, its index
// that of the list, whatever the number of threads.
TEST(ForEachTrial, EveryTrialOfEveryRangeOnce) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const Condition *first = &plan.conditions[0], *second = &plan.conditions[1];
  const std::vector<TrialsOfCondition> trials = {{second, {0, 0}}, {first, {3, 5}},  {first, {7, 7}},
                                                 {first, {9, 10}}, {second, {1, 3}}, {second, {4, 4}}};
  EXPECT_EQ(NumTrials(trials), 5);
  const std::map<std::int64_t, Key> expected = {
      {0, {0, 3}}, {1, {0, 4}}, {2, {0, 9}}, {3, {1, 1}}, {4, {1, 2}}};
  for (const int num_threads : {1, 3}) {
    Progress progress("trials", 5);
    std::mutex mutex;
    std::map<std::int64_t, Key> seen;
    ForEachTrial(trials, num_threads, &progress,
                 [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
                   const std::lock_guard lock(mutex);
                   EXPECT_TRUE(seen.emplace(index, Key{condition.index, trial}).second) << index;
                 });
    EXPECT_EQ(seen, expected);
  }
}

TEST(ForEachTrial, TheSameTrialsOfEachCondition) {
  const StudyPlan plan = MakePlan(SmallStudy());
  const std::vector<TrialsOfCondition> trials = TrialsOfEach(plan, {2, 4});
  EXPECT_EQ(NumTrials(trials), 4);
  Progress progress("trials", 4);
  std::vector<Key> seen;
  ForEachTrial(trials, 1, &progress, [&](const Condition& condition, std::uint32_t trial, std::int64_t) {
    seen.emplace_back(condition.index, trial);
  });
  EXPECT_EQ(seen, (std::vector<Key>{{0, 2}, {0, 3}, {1, 2}, {1, 3}}));
}

TEST(ForEachTrial, AnErrorEndsIt) {
  const StudyPlan plan = MakePlan(SmallStudy());
  Progress progress("trials", 4);
  int num_calls = 0;
  const auto fail = [&](const Condition&, std::uint32_t, std::int64_t) {
    ++num_calls;
    throw std::runtime_error("an error");
  };
  EXPECT_THROW(ForEachTrial(TrialsOfEach(plan, {0, 2}), 1, &progress, fail), std::runtime_error);
  EXPECT_EQ(num_calls, 1);
}

}  // namespace
}  // namespace rcme
