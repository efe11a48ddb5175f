#include <gtest/gtest.h>

#include <stdexcept>
#include <tuple>
#include <vector>

#include "experiments/run/run_trials.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using Visit = std::tuple<std::uint32_t, std::uint32_t, std::int64_t>;  // condition, trial, index

TEST(ForEachTrial, TheSameTrialsOfEachCondition) {
  const StudyPlan plan = MakePlan(SmallStudy());
  std::vector<Visit> seen;
  const auto add = [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    seen.emplace_back(condition.index, trial, index);
  };
  ForEachTrial(plan, {2, 4}, add);
  EXPECT_EQ(seen, (std::vector<Visit>{{0, 2, 0}, {0, 3, 1}, {1, 2, 2}, {1, 3, 3}}));
  ForEachTrial(plan, {4, 4}, add);
  EXPECT_EQ(seen.size(), 4u);
}

TEST(ForEachTrial, SeveralThreadsVisitTheSame) {
  std::vector<Visit> seen(4);
  const auto add = [&](const Condition& condition, std::uint32_t trial, std::int64_t index) {
    seen[static_cast<size_t>(index)] = {condition.index, trial, index};
  };
  ForEachTrial(MakePlan(SmallStudy()), {2, 4}, add, 3);
  EXPECT_EQ(seen, (std::vector<Visit>{{0, 2, 0}, {0, 3, 1}, {1, 2, 2}, {1, 3, 3}}));
}

TEST(ForEachTrial, AnErrorEndsIt) {
  int num_calls = 0;
  const auto fail = [&](const Condition&, std::uint32_t, std::int64_t) {
    ++num_calls;
    throw std::runtime_error("an error");
  };
  EXPECT_THROW(ForEachTrial(MakePlan(SmallStudy()), {0, 2}, fail), std::runtime_error);
  EXPECT_EQ(num_calls, 1);
}

}  // namespace
}  // namespace rcme
