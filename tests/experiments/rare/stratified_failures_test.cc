#include "experiments/rare/stratified_failures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "experiments/audit/claims/case.h"
#include "experiments/audit/claims/study_cases.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

StudyPlan EasyAndHardPlan(const std::string& more = "") {
  return MakePlan(
      ParseStudy("name: easy_and_hard\nseed: 5\ntrials: 10\n" + more +
                     "data: {scene: uniform_volume, num_matches: 12, sigma_px: 0.5, severity: skipped}\n"
                     "failure: {max_rotation_error_deg: 0.5, max_direction_error_deg: 5}\n"
                     "estimators:\n"
                     "  - {name: standard, options: {solver: five_point, num_iterations: 5}}\n",
                 "easy_and_hard.yaml"));
}

// The share that was asked for is run, within what 1,000 trials of the pilot and the trials themselves leave
// open: 4,000 trials, standard errors 0.01 and 0.005.
TEST(StratifyFailures, RunsTheShareThatWasAskedFor) {
  for (const double share : {0.1, 0.3}) {
    const StratifiedCell cell =
        StratifyInMemory(EasyAndHardPlan(), {.num_trials = 4000, .run_share = share}, 2)[0];
    EXPECT_NEAR(static_cast<double>(cell.num_run) / 4000.0, share, 0.045);
  }
}

// The easiest trials are run once in 64, none less often; where hardly any is run all strata are used.
TEST(StratifyFailures, GoesToTheEasiestStratum) {
  const StratifiedCell cell =
      StratifyInMemory(EasyAndHardPlan(), {.num_trials = 4000, .run_share = 0.02}, 2)[0];
  std::int64_t num_trials = 0;
  for (const StratumCount& count : cell.strata) num_trials += count.num_trials;
  EXPECT_EQ(num_trials, 4000);
  EXPECT_GT(cell.strata[6].num_trials, 1000);
  EXPECT_NEAR(static_cast<double>(cell.strata[6].num_run),
              static_cast<double>(cell.strata[6].num_trials) / 64.0,
              4.0 * std::sqrt(static_cast<double>(cell.strata[6].num_trials) / 64.0));
}

// The chances of failure that the bounds of a condition's trials tell, the greatest first.
std::vector<double> ComputeFailureChances(const StudyPlan& plan, std::uint32_t num_trials) {
  const CaseMaker make = StudyCases(plan, plan.conditions[0]);
  std::vector<double> chances;
  for (std::uint32_t trial = 0; trial < num_trials; ++trial) {
    const std::optional<Matrix5d> bound = CramerRaoBound(make(NameOfTrial(plan, plan.conditions[0], trial)));
    chances.push_back(bound ? FailureChanceOfBound(*bound, plan.study.failure) : 1.0);
  }
  std::ranges::sort(chances, std::greater<>());
  return chances;
}

// Half as many are run where the chance of failure is a quarter (the root of it, as Neyman has it): strata
// end at chances of which each is a quarter of the one before. Where one ends is known to lie between its
// least chance and the greatest of the next.
TEST(StratifyFailures, EndAtQuartersOfTheChance) {
  constexpr std::uint32_t kTrials = 3000;
  const StudyPlan plan = EasyAndHardPlan();
  const StratifiedCell cell = StratifyInMemory(plan, {.num_trials = kTrials, .run_share = 0.1}, 2)[0];
  const std::vector<double> chances = ComputeFailureChances(plan, kTrials);
  std::vector<Interval> ends;
  size_t num_within = 0;
  for (size_t k = 0; k + 1 < kNumStrata; ++k) {
    num_within += static_cast<size_t>(cell.strata[k].num_trials);
    if (num_within == 0) continue;
    if (num_within == chances.size()) break;
    ends.push_back({chances[num_within], chances[num_within - 1]});
  }
  ASSERT_GE(ends.size(), 2u);
  double narrowest = 4.0;  // of the intervals of the ratio, their upper over their lower end
  for (size_t k = 1; k < ends.size(); ++k) {
    const double least = ends[k - 1].lower / ends[k].upper, greatest = ends[k - 1].upper / ends[k].lower;
    EXPECT_LE(least, 4.0) << k;
    EXPECT_GE(greatest, 4.0) << k;
    narrowest = std::min(narrowest, greatest / least);
  }
  EXPECT_LT(narrowest, 1.4);  // a ratio of two, or of eight, would be seen
}

TEST(StratifyFailures, RefusesRepeatedScenes) {
  EXPECT_TRUE(ThrowsInputError(
      [&] { StratifyInMemory(EasyAndHardPlan("repeats_per_scene: 2\n"), {.num_trials = 10}, 1); },
      {"repeats_per_scene"}));
}

// Tails of one axis beyond the bound, of the greatest eigenvalue: 2 deg against 4 deg, where the axes of the
// ellipse are turned.
TEST(FailureChanceOfBound, TakesTheGreatestEigenvalue) {
  const double rad = std::acos(-1.0) / 180.0;
  Matrix5d bound = Matrix5d::Zero();
  bound.topLeftCorner<3, 3>() = 1e-8 * Eigen::Matrix3d::Identity();
  Eigen::Matrix2d turn;
  turn << std::cos(0.5), -std::sin(0.5), std::sin(0.5), std::cos(0.5);
  bound.bottomRightCorner<2, 2>() =
      turn * Eigen::Vector2d(0.01 * rad * rad, 4.0 * rad * rad).asDiagonal() * turn.transpose();
  EXPECT_NEAR(FailureChanceOfBound(bound, {3.0, 4.0}), 0.0455003, 1e-7);
}

}  // namespace
}  // namespace rcme
