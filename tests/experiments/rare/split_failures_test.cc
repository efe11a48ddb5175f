#include "experiments/rare/split_failures.h"

#include <gtest/gtest.h>

#include <chrono>
#include <set>
#include <thread>

#include "experiments/study/study_file.h"
#include "stats/splitting.h"
#include "tests/test_support/error_terminal.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

// Two conditions, quick to run, of which each fails now and then, unless other bounds are given.
StudyPlan TwoConditions(
    const std::string& bounds = "{max_rotation_error_deg: 0.5, max_direction_error_deg: 2.5}") {
  return MakePlan(
      ParseStudy("name: two\nseed: 5\ntrials: 10\n"
                 "data: {scene: uniform_volume, num_matches: 20, sigma_px: 0.5, severity: skipped}\n"
                 "factors: {outlier_ratio: [0.1, 0.1001]}\n"
                 "failure: " +
                     bounds +
                     "\nestimators:\n"
                     "  - {name: standard, options: {solver: five_point, num_iterations: 10}}\n",
                 "two.yaml"));
}
const RareEffort kEffort{{.num_particles = 20, .num_moves = 1, .kept_share = 0.2}, 4};

std::vector<RareCell> SplitBy(std::uint64_t seed, int num_threads) {
  return SplitInMemory(TwoConditions(), seed, kEffort, num_threads);
}

// What a replicate went through.
std::vector<double> ListSteps(const SplittingReplicate& replicate) {
  std::vector<double> path = replicate.shares;
  path.insert(path.end(), replicate.acceptance.begin(), replicate.acceptance.end());
  path.push_back(static_cast<double>(replicate.num_ancestors));
  return path;
}

// Each replicate has a stream of its own, each condition too, and each seed; threads change nothing.
TEST(SplitFailures, HasStreamsOfItsOwnForEachReplicate) {
  const std::vector<RareCell> cells = SplitBy(1, 1), again = SplitBy(1, 2), other = SplitBy(2, 1);
  ASSERT_EQ(cells.size(), 2u);
  std::set<std::vector<double>> paths;
  for (size_t c = 0; c < 2; ++c) {
    ASSERT_EQ(cells[c].condition, c);
    ASSERT_EQ(cells[c].replicates.size(), 4u);
    for (size_t r = 0; r < 4; ++r) {
      EXPECT_EQ(ListSteps(cells[c].replicates[r]), ListSteps(again[c].replicates[r]));
      paths.insert(ListSteps(cells[c].replicates[r]));
    }
    EXPECT_EQ(cells[c].rate.estimate, again[c].rate.estimate);
  }
  EXPECT_GE(paths.size(), 6u);  // of eight, whose shares may agree by chance
  EXPECT_NE(cells[0].pilot.levels.levels, cells[1].pilot.levels.levels);
  EXPECT_NE(ListSteps(cells[0].replicates[0]), ListSteps(other[0].replicates[0]));
}

// The mean of the replicates is the rate.
TEST(SplitFailures, IsTheMeanOfItsReplicates) {
  for (const RareCell& cell : SplitBy(1, 1)) {
    double sum = 0.0;
    for (const SplittingReplicate& replicate : cell.replicates) sum += replicate.estimate;
    EXPECT_NEAR(cell.rate.estimate, sum / 4.0, 1e-15);
  }
}

// The stream of a replicate is that of the seed, its condition and its number, from 1 on; the pilot's number
// is 0.
TEST(SplitFailures, DrawsFromTheStreamsOfItsConditions) {
  const StudyPlan plan = TwoConditions();
  const std::vector<RareCell> cells = SplitBy(1, 1);
  ASSERT_EQ(cells.size(), 2u);
  for (size_t c = 0; c < 2; ++c) {
    const FailingMotion system(plan, plan.conditions[c], 0);
    const auto stream_of = [&](std::uint32_t number) {
      return RandomStream({1, plan.conditions[c].stream_key, number, kSplittingPurpose});
    };
    RandomStream of_pilot = stream_of(0);
    const SplittingPilot pilot = FindLevels(system, kEffort.splitting, of_pilot);
    EXPECT_EQ(pilot.levels.levels, cells[c].pilot.levels.levels);
    for (size_t r = 0; r < cells[c].replicates.size(); ++r) {
      RandomStream rng = stream_of(static_cast<std::uint32_t>(r) + 1);
      EXPECT_EQ(ListSteps(Split(system, kEffort.splitting, pilot.levels, rng)),
                ListSteps(cells[c].replicates[r]));
    }
  }
}

// No motion is off by more than 180 deg, so that no levels lead to failure and no replicate is run.
TEST(SplitFailures, RunsNoReplicateWithoutLevels) {
  const StudyPlan plan = TwoConditions("{max_rotation_error_deg: 180, max_direction_error_deg: 180}");
  Runner runner = Runner::InMemory(PlanSplitting(plan, 1, kEffort), 1);
  for (const RareCell& cell : SplitFailures(plan, 1, kEffort, &runner)) EXPECT_TRUE(cell.replicates.empty());
  EXPECT_EQ(runner.results().results.size(), 2u);
}

}  // namespace
}  // namespace rcme
