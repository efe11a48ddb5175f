#include "experiments/run/run_trials.h"

#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using Key = std::pair<std::uint32_t, std::uint32_t>;  // condition, trial

// Lacks some ranges of places, and counts what it is given.
class ListKeeper : public TrialKeeper {
 public:
  std::map<std::uint32_t, std::vector<TrialRange>> missing;  // by condition
  std::map<Key, int> kept;
  int num_flushes = 0;
  bool can_keep = true;

  std::vector<TrialRange> MissingTrials(std::uint32_t condition, std::uint32_t, const ShardTrials&) override {
    return missing[condition];
  }
  std::string NoteOrigin(const TrialOrigin&) override { return {}; }
  void Keep(const TrialResult& result) override {
    if (!can_keep) throw std::runtime_error("full");
    const std::lock_guard lock(mutex_);
    ++kept[{result.problem.condition, result.problem.trial}];
  }
  void Flush() override { ++num_flushes; }
  std::string DescribeKept(std::int64_t) const override { return {}; }

 private:
  std::mutex mutex_;
};

// Ranges of one condition with gaps, some that are empty, and another condition: each trial once, whatever
// the number of threads.
TEST(RunTrials, EveryTrialOfEveryRangeOnce) {
  const StudyPlan plan = MakePlan(SmallStudy());
  for (const int num_threads : {1, 3}) {
    ListKeeper keeper;
    keeper.missing = {{0, {{0, 0}, {2, 4}, {4, 4}, {5, 6}}}, {1, {{1, 3}, {4, 4}}}};
    const RunReport report = RunTrials(plan, {}, num_threads, &keeper);
    EXPECT_EQ(report.num_trials, 12);
    EXPECT_EQ(report.num_run_now, 5);
    EXPECT_EQ(keeper.kept,
              (std::map<Key, int>{{{0, 2}, 1}, {{0, 3}, 1}, {{0, 5}, 1}, {{1, 1}, 1}, {{1, 2}, 1}}));
    EXPECT_EQ(keeper.num_flushes, 1);
  }
}

TEST(RunTrials, PlacesAreThoseOfTheShard) {
  const StudyPlan plan = MakePlan(SmallStudy());
  std::map<Key, int> all;
  for (const std::uint32_t number : {1u, 2u}) {
    ListKeeper keeper;
    keeper.missing = {{0, {{0, 3}}}, {1, {{0, 3}}}};
    EXPECT_EQ(RunTrials(plan, {number, 2}, 1, &keeper).num_trials, 6);
    all.merge(keeper.kept);
  }
  EXPECT_EQ(all.size(), 12u);
}

TEST(RunTrials, AnErrorEndsItAndFlushes) {
  ListKeeper keeper;
  keeper.missing = {{0, {{0, 6}}}};
  keeper.can_keep = false;
  EXPECT_THROW(RunTrials(MakePlan(SmallStudy()), {}, 1, &keeper), std::runtime_error);
  EXPECT_EQ(keeper.num_flushes, 1);
}

}  // namespace
}  // namespace rcme
