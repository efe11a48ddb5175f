#include "experiments/core/work/shard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

Environment Setting(const std::map<std::string, std::string>& values) {
  return [values](const std::string& name) -> std::optional<std::string> {
    const auto found = values.find(name);
    return found == values.end() ? std::nullopt : std::optional(found->second);
  };
}

Shard Parsed(const std::string& text, const std::map<std::string, std::string>& values = {}) {
  return ParseShard(text, Setting(values));
}

TEST(Shard, SaysWhichItIs) {
  EXPECT_EQ(Parsed("3/64"), (Shard{3, 64}));
  EXPECT_EQ(Parsed("1/1"), Shard());
  EXPECT_EQ(Shard().Text(), "");
  EXPECT_EQ(Parsed("3/64").Text(), "3/64");
  for (const std::string wrong :
       {"", "3", "0/4", "5/4", "-1/4", "1/0", "1/2/3", "a/4", "1/1000001", "1.5/4", "auto/"})
    EXPECT_TRUE(ThrowsInputError([&] { Parsed(wrong); }, {"--shard", "'" + wrong + "'", "I/N"})) << wrong;
}

TEST(Shard, IsTheTaskOfAnArrayOrAJob) {
  EXPECT_EQ(Parsed("auto/64", {{"SLURM_ARRAY_TASK_ID", "64"}}), (Shard{64, 64}));
  EXPECT_EQ(Parsed("auto/64", {{"JOB_COMPLETION_INDEX", "0"}}), (Shard{1, 64}));
  // The whole array says it all, whatever number it begins with.
  for (const int first : {0, 1, 7}) {
    const std::map<std::string, std::string> array = {{"SLURM_ARRAY_TASK_ID", std::to_string(first + 2)},
                                                      {"SLURM_ARRAY_TASK_COUNT", "4"},
                                                      {"SLURM_ARRAY_TASK_MIN", std::to_string(first)},
                                                      {"SLURM_ARRAY_TASK_MAX", std::to_string(first + 3)}};
    EXPECT_EQ(Parsed("auto", array), (Shard{3, 4})) << first;
  }
  EXPECT_TRUE(ThrowsInputError([] { Parsed("auto/4"); }, {"SLURM_ARRAY_TASK_ID", "JOB_COMPLETION_INDEX"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        Parsed("auto", {{"JOB_COMPLETION_INDEX", "0"}});
      },
      {"SLURM_ARRAY_TASK_COUNT"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        Parsed("auto/4", {{"SLURM_ARRAY_TASK_ID", "0"}});
      },
      {"no shard 0 of 4"}));
  EXPECT_TRUE(ThrowsInputError([] { Parsed("auto/4", {{"SLURM_ARRAY_TASK_ID", "x"}}); }, {"'x'"}));
}

// What is submitted again is a part of the array, whose count is not that of the shards.
TEST(Shard, APartOfAnArrayIsNotTakenForTheWhole) {
  const std::map<std::string, std::string> part = {{"SLURM_ARRAY_TASK_ID", "17"},
                                                   {"SLURM_ARRAY_TASK_COUNT", "3"},
                                                   {"SLURM_ARRAY_TASK_MIN", "3"},
                                                   {"SLURM_ARRAY_TASK_MAX", "18"}};
  EXPECT_TRUE(ThrowsInputError([&] { Parsed("auto", part); }, {"3 tasks from 3 to 18", "auto/N"}));
  EXPECT_EQ(Parsed("auto/64", part), (Shard{17, 64}));
}

TEST(Shard, EveryTrialIsInOneShardAndEveryShardKnowsItsOwn) {
  for (const int repeats : {1, 3}) {
    for (const std::uint32_t count : {1u, 2u, 7u, 64u}) {
      for (std::uint32_t condition = 0; condition < 5; ++condition) {
        constexpr std::uint32_t kNumTrials = 200;
        std::set<std::uint32_t> seen;
        for (std::uint32_t number = 1; number <= count; ++number) {
          const ShardTrials trials({number, count}, condition, repeats);
          for (std::uint32_t place = 0; place < trials.NumBefore(kNumTrials); ++place) {
            const std::uint32_t trial = trials.TrialAt(place);
            EXPECT_LT(trial, kNumTrials);
            EXPECT_TRUE(seen.insert(trial).second) << trial;
            EXPECT_TRUE(trials.Has(trial));
            EXPECT_EQ(trials.NumBefore(trial), place);
            EXPECT_EQ(FindShard(condition, trial / static_cast<std::uint32_t>(repeats), count), number);
          }
        }
        EXPECT_EQ(seen.size(), kNumTrials);
      }
    }
  }
  const ShardTrials all;
  EXPECT_TRUE(all.Has(17));
  EXPECT_EQ(all.TrialAt(17), 17u);
  EXPECT_EQ(all.NumBefore(17), 17u);
}

// Cost of the slowest of `count` shards over the mean. Conditions cost from 1 to `spread` a trial, neighbours
// about the same.
double WorstOverMean(std::uint32_t count, std::uint32_t num_conditions, std::uint32_t num_trials,
                     double spread) {
  std::vector<double> costs;
  for (std::uint32_t number = 1; number <= count; ++number) {
    double cost = 0.0;
    for (std::uint32_t c = 0; c < num_conditions; ++c) {
      const double of_trial = 1.0 + (spread - 1.0) * c / num_conditions;
      const std::uint32_t num = ShardTrials({number, count}, c, 1).NumBefore(num_trials);
      EXPECT_GE(num, num_trials / count);
      EXPECT_LE(num, (num_trials + count - 1) / count) << "a condition is not divided evenly";
      cost += of_trial * num;
    }
    costs.push_back(cost);
  }
  const double mean = std::accumulate(costs.begin(), costs.end(), 0.0) / count;
  return *std::ranges::max_element(costs) / mean;
}

// One condition cannot be divided better than to a trial: from four trials a shard on that is at most 1.25.
// Many conditions even it out, also where a condition has fewer trials than there are shards.
TEST(Shard, CostsAreEven) {
  double worst = 0.0;
  for (const double spread : {1.0, 20.0}) {
    for (std::uint32_t num_trials = 256; num_trials <= 700; num_trials += 37) {
      for (std::uint32_t num_conditions = 1; num_conditions <= 60; ++num_conditions)
        worst = std::max(worst, WorstOverMean(64, num_conditions, num_trials, spread));
    }
  }
  EXPECT_LE(worst, 1.25);
  for (const double spread : {1.0, 20.0}) {
    EXPECT_LE(WorstOverMean(64, 20, 100, spread), 1.2) << spread;
    EXPECT_LE(WorstOverMean(64, 100, 30, spread), 1.2) << spread;
    EXPECT_LE(WorstOverMean(64, 400, 10, spread), 1.2) << spread;
  }
}

TEST(Shard, ArraysOfSlurm) {
  EXPECT_EQ(ArrayText({}), "");
  EXPECT_EQ(ArrayText({3, 17, 18, 19}), "3,17-19");
  EXPECT_EQ(ArrayText({1, 2, 4}), "1-2,4");
}

}  // namespace
}  // namespace rcme
