// Errors beyond their protection level as a rare event: the same answers as `rcme integrity` counts, and the
// same rate by splitting as by plain trials.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/integrity/integrity_counts.h"
#include "experiments/rare/failing_motion.h"
#include "experiments/rare/split_failures.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

using Kind = RareEvent::Kind;

StudyPlan MakeNoisyPlan() {
  return MakePlan(
      ParseStudy("name: misleading\nseed: 6\ntrials: 10\n"
                 "data: {scene: uniform_volume, motion: sideways, num_matches: 30, outlier_ratio: 0.1, "
                 "sigma_px: 0.5, severity: skipped}\n"
                 "estimators:\n"
                 "  - {name: standard, options: {solver: five_point, num_iterations: 20}}\n",
                 "misleading.yaml"));
}

TEST(ErrorOverLevel, IsBeyondOneWhereIntegrityCountsAMisleadingAnswer) {
  const StudyPlan plan = MakeNoisyPlan();
  for (const double risk : {0.3, 0.05}) {
    int num_misleading = 0;
    for (std::uint32_t trial = 0; trial < 200; ++trial) {
      const TrialResult result = RunTrial(plan, plan.conditions[0], trial);
      const IntegrityTally tally = CountTrial(result, {.risk = risk}).tally;
      for (const auto& [kind, quantity] : {std::pair{Kind::kMisleadingRotation, size_t{0}},
                                           std::pair{Kind::kMisleadingDirection, size_t{1}}}) {
        const double value = ErrorOverLevel(result.estimates[0], result.records[0], {kind, risk});
        EXPECT_EQ(value > 1.0, tally.NumMisleading(quantity) == 1) << trial << Name(kind);
        num_misleading += value > 1.0;
      }
    }
    EXPECT_GT(num_misleading, 5);
  }
}

TEST(ErrorOverLevel, IsNothingWithoutAnAnswerOrItsError) {
  TrialRecord record;
  record.status = MotionStatus::kNoCandidate;
  EXPECT_EQ(ErrorOverLevel({}, record, {Kind::kMisleadingRotation}), 0.0);
  record.status = MotionStatus::kOk;
  record.direction_error_deg = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ErrorOverLevel({}, record, {Kind::kMisleadingDirection}), 0.0);
}

// Of 3,000 plain trials and of 20 replicates; a z-test at 1e-4. The rate of the other event is another.
TEST(SplitFailures, MisleadingAnswersHaveTheRateOfPlainTrials) {
  const StudyPlan plan = MakeNoisyPlan();
  const RareEvent event{Kind::kMisleadingDirection, 0.02};
  constexpr std::uint32_t kPlain = 3000;
  double count = 0.0;
  for (std::uint32_t trial = 0; trial < kPlain; ++trial) {
    const TrialResult result = RunTrial(plan, plan.conditions[0], trial);
    count += ErrorOverLevel(result.estimates[0], result.records[0], event) > 1.0;
  }
  const double plain = count / kPlain;
  EXPECT_GT(plain, 0.01);
  const RareEffort effort{{.num_particles = 60, .num_moves = 3}, 20, event};
  const SplittingRate rate = SplitInMemory(plan, 3, effort, 1)[0].rate;
  const double z = (rate.estimate - plain) /
                   std::sqrt(plain * (1.0 - plain) / kPlain + rate.standard_error * rate.standard_error);
  EXPECT_LT(std::abs(z), 3.89) << rate.estimate << " for " << plain;
}

// A checkpoint of one event is none of another.
TEST(PlanSplitting, NamesTheEvent) {
  const StudyPlan plan = MakeNoisyPlan();
  const auto identity = [&](const RareEvent& event) {
    return PlanSplitting(plan, 1, {{}, 20, event}).identity;
  };
  EXPECT_NE(identity({Kind::kMisleadingRotation}), identity({}));
  EXPECT_NE(identity({Kind::kMisleadingRotation}), identity({Kind::kMisleadingDirection}));
  EXPECT_NE(identity({Kind::kMisleadingRotation, 0.1}), identity({Kind::kMisleadingRotation, 0.2}));
}

}  // namespace
}  // namespace rcme
