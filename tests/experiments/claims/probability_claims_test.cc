// The audit's claim about stated probabilities of failure, with answers of known quality planted.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "experiments/claims/calibration.h"
#include "experiments/claims/call_estimator.h"
#include "experiments/claims/decide_check.h"
#include "experiments/claims/design.h"

namespace rcme {
namespace {

TrialRecord Answer(double probability, bool failed) {
  TrialRecord record;
  record.status = MotionStatus::kOk;
  record.rotation_error_deg = failed ? 90.0 : 0.1;
  record.failure_probability = probability;
  return record;
}

TEST(StatedProbability, StatisticByHand) {
  const Outcome wrong = StatedProbabilityStatistic(Answer(0.25, true));
  EXPECT_EQ(wrong[0], -0.75);
  EXPECT_EQ(wrong[1], -0.1875);
  EXPECT_TRUE(std::isnan(wrong[2])) << "not a sure one";
  EXPECT_EQ(wrong[3], 0.5625);
  EXPECT_EQ(wrong[4], 0.25);
  EXPECT_EQ(StatedProbabilityStatistic(Answer(0.1, false))[2], 0.0);
  EXPECT_EQ(StatedProbabilityStatistic(Answer(0.0, true))[2], 1.0);
  TrialRecord refusal = Answer(0.9, false);
  refusal.status = MotionStatus::kTooUncertain;
  for (const TrialRecord& silent : {refusal, Answer(std::nan(""), true)}) {
    for (const double value : StatedProbabilityStatistic(silent)) EXPECT_TRUE(std::isnan(value));
  }
}

TEST(StatedProbability, IsAskedOfWhoStatesIt) {
  EXPECT_TRUE(StatesProbability("rcme_calibrated"));
  EXPECT_FALSE(StatesProbability("standard"));
}

// A trial in six fails with a probability that is uniform on 0..0.5, the others never; `stated` of that.
Check CheckOf(double (*stated)(double right)) {
  Check check;
  check.targets = StatedProbabilityTargets();
  check.limits = kStatedProbability.limits;
  check.trial = [stated](const StreamName& name) {
    RandomStream rng(name);
    const double right = rng.Uniform() < 1.0 / 6.0 ? 0.5 * rng.Uniform() : 0.0;
    const bool failed = rng.Uniform() < right;
    return StatedProbabilityStatistic(Answer(stated(right), failed));
  };
  return check;
}

Verdict VerdictOn(double (*stated)(double), std::uint64_t seed, Budget budget = Budget::kQuick) {
  return DecideCheck(CheckOf(stated), {seed, 1, budget, 1.0 - 0.05 / 850.0})
      .verdict.value_or(Verdict::kUndecided);
}

// Ten seeds each. Right ones are never called wrong and mostly right; too small, too great, one number
// for all and, with the full budget, the wrong order are all found.
TEST(StatedProbability, FaultsAreFoundAndRightOnesAreNot) {
  int num_held = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Verdict right = VerdictOn([](double p) { return p; }, seed);
    EXPECT_NE(right, Verdict::kDoesNotHold) << seed;
    num_held += right == Verdict::kHolds ? 1 : 0;
    EXPECT_EQ(VerdictOn([](double p) { return 0.3 * p; }, seed), Verdict::kDoesNotHold) << "too sure";
    EXPECT_EQ(VerdictOn([](double p) { return 2.0 * p; }, seed), Verdict::kDoesNotHold) << "too great";
    EXPECT_EQ(VerdictOn([](double) { return 1.0 / 24.0; }, seed), Verdict::kDoesNotHold)
        << "one number for all";
    EXPECT_EQ(VerdictOn([](double p) { return p > 0.0 ? 0.5 - p : 0.0; }, seed, Budget::kFull),
              Verdict::kDoesNotHold)
        << "right on average, but turned around";
  }
  EXPECT_GE(num_held, 8);
}

}  // namespace
}  // namespace rcme
