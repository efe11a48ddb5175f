// Rare failures: the random inputs of a trial as a system for splitting, and trials in strata.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/rare/rare_output.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

// Fails about once in twelve trials: bounds near the noise's error.
StudyPlan FrequentFailures(const std::string& more_data = "") {
  return MakePlan(
      ParseStudy("name: frequent\nseed: 5\ntrials: 10\n"
                 "data: {scene: uniform_volume, num_matches: 30, outlier_ratio: 0.1, sigma_px: 0.5, "
                 "severity: skipped" +
                     more_data +
                     "}\n"
                     "failure: {max_rotation_error_deg: 0.5, max_direction_error_deg: 2.5}\n"
                     "estimators:\n"
                     "  - {name: standard, options: {solver: five_point, num_iterations: 20}}\n",
                 "frequent.yaml"));
}

std::int64_t CountFailures(const StudyPlan& plan, std::uint32_t num_trials) {
  std::int64_t count = 0;
  for (std::uint32_t trial = 0; trial < num_trials; ++trial)
    count += HasFailed(RunTrial(plan, plan.conditions[0], trial).records[0], plan.study.failure);
  return count;
}

TEST(ErrorOverBound, IsBeyondOneWhereTheMotionHasFailed) {
  const FailureBounds bounds{3.0, 15.0};
  TrialRecord record;
  record.status = MotionStatus::kOk;
  record.rotation_error_deg = 1.5;
  record.direction_error_deg = 5.0;
  EXPECT_DOUBLE_EQ(ErrorOverBound(record, bounds), 0.5);
  record.direction_error_deg = 30.0;
  EXPECT_DOUBLE_EQ(ErrorOverBound(record, bounds), 2.0);
  record.direction_error_deg = std::numeric_limits<double>::quiet_NaN();  // a pure rotation
  EXPECT_DOUBLE_EQ(ErrorOverBound(record, bounds), 0.5);
  for (const double ulps : {-1.0, 0.0, 1.0}) {
    record.rotation_error_deg = 3.0 + ulps * std::numeric_limits<double>::epsilon() * 2.0;
    EXPECT_EQ(ErrorOverBound(record, bounds) > 1.0, HasFailed(record, bounds)) << ulps;
  }
  record.rotation_error_deg = 0.0;
  EXPECT_EQ(ErrorOverBound(record, {0.0, 15.0}) > 1.0, HasFailed(record, {0.0, 15.0}));
  record.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(ErrorOverBound(record, bounds), 0.0);
  record.status = MotionStatus::kInvalidMotion;
  EXPECT_EQ(ErrorOverBound(record, bounds), std::numeric_limits<double>::infinity());
}

TEST(FailingMotion, HasTheLawOfATrialAndItsMovesKeepIt) {
  // The rate of trials drawn by splitting's state, before and after moves that are all accepted, is that of
  // plain trials. z-tests at 1e-4.
  const StudyPlan plan = FrequentFailures(", motion: sideways");
  const FailingMotion system(plan, plan.conditions[0], 0);
  constexpr std::uint32_t kPlain = 6000;
  const double plain = static_cast<double>(CountFailures(plan, kPlain)) / kPlain;
  EXPECT_GT(plain, 0.02);
  EXPECT_LT(plain, 0.3);
  Moments drawn, moved;
  for (std::uint32_t r = 0; r < 40; ++r) {
    RandomStream rng({.seed = 1, .trial = r, .purpose = 93});
    const SplittingReplicate replicate =
        Split(system, {.num_particles = 100, .num_moves = 4}, {{-1.0}, {0.5}}, rng);
    EXPECT_EQ(replicate.shares[0], 1.0);
    EXPECT_EQ(replicate.acceptance[0], 1.0);
    drawn.Add(static_cast<double>(replicate.num_drawn_events) / 100.0);
    moved.Add(replicate.estimate);
  }
  const double plain_variance = plain * (1.0 - plain) / kPlain;
  for (const Moments& rate : {drawn, moved}) {
    const double z = (rate.mean() - plain) / std::sqrt(plain_variance + rate.variance() / 40.0);
    EXPECT_LT(std::abs(z), 3.89) << rate.mean() << " for " << plain;
  }
}

TEST(FailingMotion, LocalMovesChangeTheNoiseSomePointsOrTheMotion) {
  const StudyPlan plan = FrequentFailures(", motion: sideways");
  const FailingMotion system(plan, plan.conditions[0], 0);
  RandomStream rng({.seed = 1, .purpose = 94});
  const MotionInputs state = system.Draw(rng);
  int num_noise = 0, num_points = 0, num_motion = 0, num_moved = 0, num_renewed = 0;
  for (int i = 0; i < 1600; ++i) {
    bool is_local = false;
    const MotionInputs moved = system.Propose(state, 0.3, rng, is_local);
    const bool has_other_scene = moved.scene != state.scene;
    const int num_changed = has_other_scene + (moved.outlier_seed != state.outlier_seed) +
                            (moved.sampling_seed != state.sampling_seed) + (moved.noise != state.noise);
    EXPECT_EQ(num_changed, 1);
    num_noise += moved.noise != state.noise;
    if (!is_local || !has_other_scene) continue;
    int renewed = 0;
    for (size_t k = 0; k < state.scene->points_in_cam1.size(); ++k) {
      renewed += moved.scene->points_in_cam1[k] != state.scene->points_in_cam1[k];
      EXPECT_TRUE(moved.scene->Sees(moved.scene->points_in_cam1[k]));
    }
    const bool has_moved = moved.scene->cam2_from_cam1_true.R != state.scene->cam2_from_cam1_true.R;
    EXPECT_TRUE(!has_moved || renewed == 0);
    num_moved += has_moved;
    num_renewed += renewed;
    // None of the points is renewed with probability 0.955^30 = 0.25 if it was the points' turn.
    (renewed > 0 ? num_points : num_motion) += 1;
  }
  // Within 3.9 standard deviations of one half, of 1/8 * 0.75, and of 1/8 * 1.25.
  EXPECT_NEAR(num_noise, 800, 78);
  EXPECT_NEAR(num_points, 150, 46);
  EXPECT_NEAR(num_motion, 250, 57);
  EXPECT_NEAR(num_renewed, 0.045 * 30 * 200, 75);
  EXPECT_GT(num_moved, 60);
}

TEST(SplitFailures, SaysWhatItCannotTake) {
  const auto split = [](const std::string& more_data) {
    const StudyPlan plan = FrequentFailures(more_data);
    FailingMotion(plan, plan.conditions[0], 0);
  };
  EXPECT_TRUE(ThrowsInputError([&] { split(", noise: laplace"); }, {"noise", "gaussian", "stratified"}));
  EXPECT_TRUE(ThrowsInputError([&] { split(", outlier_count: bernoulli, tilted_to: 0.5"); }, {"tilted_to"}));
}

TEST(StratifyFailures, RunsAllTrialsWhereAllAreWanted) {
  // Then it is the plain count of the plain trials.
  const StudyPlan plan = FrequentFailures();
  const StratifiedCell cell = StratifyInMemory(plan, {.num_trials = 1000, .run_share = 1.0}, 1)[0];
  EXPECT_EQ(cell.num_run, 1000);
  EXPECT_EQ(cell.strata[0].num_failed, CountFailures(plan, 1000));
  EXPECT_DOUBLE_EQ(cell.rate.estimate, static_cast<double>(cell.strata[0].num_failed) / 1000.0);
}

TEST(StratifyFailures, IsUnbiasedAndRunsTheHardOnes) {
  // Against plain trials of other numbers (another seed); z-test at 1e-4.
  const StudyPlan plan = FrequentFailures();
  Study other = plan.study;
  other.seed = 6;
  const double plain = static_cast<double>(CountFailures(MakePlan(other), 6000)) / 6000.0;
  const StratifiedCell cell = StratifyInMemory(plan, {.num_trials = 20'000, .run_share = 0.2}, 1)[0];
  const double z = (cell.rate.estimate - plain) /
                   std::sqrt(plain / 6000.0 + cell.rate.standard_error * cell.rate.standard_error);
  EXPECT_LT(std::abs(z), 3.89) << cell.rate.estimate << " for " << plain;
  EXPECT_NEAR(static_cast<double>(cell.num_run), 4000.0, 800.0);
  EXPECT_LT(cell.rate.standard_error, 0.15 * plain);
  // Hard strata fail more often than easy ones.
  const auto rate_of = [&](size_t k) {
    return static_cast<double>(cell.strata[k].num_failed) /
           std::max(1.0, static_cast<double>(cell.strata[k].num_run));
  };
  EXPECT_GT(rate_of(0), 4.0 * rate_of(3));
  for (size_t k = 0; k < kNumStrata; ++k) {
    const StratumCount& count = cell.strata[k];
    const double wanted = std::ldexp(static_cast<double>(count.num_trials), -static_cast<int>(k));
    EXPECT_NEAR(static_cast<double>(count.num_run), wanted, 1e-9 + 3.9 * std::sqrt(wanted)) << k;
  }
}

TEST(FailureChanceOfBound, IsTheGreatestOfTwoNormalTails) {
  // Standard deviations: rotation 1, 2, 3 deg, direction 4, 5 deg.
  const double rad_per_deg = std::acos(-1.0) / 180.0;
  Vector5d variances;
  variances << 1.0, 4.0, 9.0, 16.0, 25.0;
  const Matrix5d bound = (rad_per_deg * rad_per_deg * variances).asDiagonal();
  EXPECT_NEAR(FailureChanceOfBound(bound, {3.0, 15.0}), 0.3173105, 1e-7);  // 1 sd against 3
  EXPECT_NEAR(FailureChanceOfBound(bound, {9.0, 10.0}), 0.0455003, 1e-7);  // 3 sd against 2
}

TEST(RareRow, SharesOfBruteForce) {
  // 1,000 calls for a relative standard error of 10 % at 1e-4, where plain trials take 99.99 / 1e-4 * ... =
  // 999,900.
  RareRow row;
  row.estimate = 1e-4;
  row.standard_error = 1e-5;
  row.num_calls = 1000;
  EXPECT_NEAR(row.BruteForceShare(), 1000.0 / 999'900.0, 1e-12);
}

}  // namespace
}  // namespace rcme
