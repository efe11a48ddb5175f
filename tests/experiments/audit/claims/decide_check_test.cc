#include "experiments/audit/claims/decide_check.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stats/confidence_sequence.h"
#include "stats/constants.h"
#include "stats/intervals.h"
#include "tests/test_support/coverage_count.h"

namespace rcme {
namespace {

Target RateWithin(double low, double high) { return ClaimedRate("rate", 0.5 * (low + high), {low, high}); }

// A check whose trials succeed with the given probability.
Check BernoulliCheck(double probability, const Target& target, const TrialLimits& limits) {
  Check check;
  check.targets = {target};
  check.limits = limits;
  check.trial = [probability](const StreamName& name) -> Outcome {
    return {RandomStream(name).Uniform() < probability ? 1.0 : 0.0};
  };
  return check;
}

// A check that yields the trial's number.
Check CountingCheck(const std::vector<Target>& targets, const TrialLimits& limits) {
  Check check;
  check.targets = targets;
  check.limits = limits;
  check.trial = [](const StreamName& name) -> Outcome { return {static_cast<double>(name.trial)}; };
  return check;
}

TEST(DecideCheck, StopsAtTheVerdictAndNotBeforeTheLeastNumber) {
  const Check sure = BernoulliCheck(1.0, RateWithin(0.9, 1.0), {0, 100'000, 100'000});
  const CheckResult result = DecideCheck(sure, {});
  EXPECT_EQ(result.verdict, Verdict::kHolds);
  EXPECT_LT(result.num_trials, 1'000);
  EXPECT_EQ(result.targets[0].measured, 1.0);
  EXPECT_EQ(result.targets[0].n, result.num_trials);

  Check longer = sure;
  longer.limits.min = 5'000;
  EXPECT_GE(DecideCheck(longer, {}).num_trials, 5'000);
}

TEST(DecideCheck, EndsUndecidedAtTheBudgetAndSaysHowManyWouldDo) {
  const Check check = BernoulliCheck(0.945, RateWithin(0.94, 0.96), {0, 2'000, 1'000'000});
  const CheckResult quick = DecideCheck(check, {});
  EXPECT_EQ(quick.verdict, Verdict::kUndecided);
  EXPECT_EQ(quick.num_trials, 2'000);
  EXPECT_GT(quick.targets[0].trials_to_decide, 2'000.0);
  CheckRun full;
  full.budget = Budget::kFull;
  const CheckResult decided = DecideCheck(check, full);
  EXPECT_EQ(decided.verdict, Verdict::kHolds);
}

TEST(DecideCheck, EveryTrialIsCountedOnceWhateverTheThreads) {
  Target first_half = MeasuredRate("first");
  first_half.kind = Target::Kind::kAtMost;
  first_half.threshold = 499.0;
  const Target mean = MeasuredMean("mean");
  const Check check = CountingCheck({first_half, mean}, {0, 1'000, 1'000});
  for (const int threads : {1, 2, 5}) {
    CheckRun run;
    run.num_threads = threads;
    const CheckResult result = DecideCheck(check, run);
    EXPECT_EQ(result.num_trials, 1'000);
    EXPECT_EQ(result.targets[0].measured, 0.5);
    EXPECT_DOUBLE_EQ(result.targets[1].measured, 499.5);
    EXPECT_FALSE(result.verdict);  // nothing is claimed
  }
}

TEST(DecideCheck, KindsCountWhatTheySay) {
  Check check;
  check.limits = {0, 64, 64};
  check.trial = [](const StreamName& name) -> Outcome {
    const double values[] = {-1.0, 0.0, 2.0, std::numeric_limits<double>::infinity()};
    return {values[name.trial % 4], name.trial % 4 == 0 ? kNaN : 1.0};
  };
  check.targets = {MeasuredRate("coverage"), MeasuredRate("at most"), MeasuredRate("rate"),
                   MeasuredRate("conditional rate", 1)};
  check.targets[0].kind = Target::Kind::kCoverage;
  check.targets[1].kind = Target::Kind::kAtMost;
  check.targets[0].threshold = check.targets[1].threshold = 2.0;
  const CheckResult result = DecideCheck(check, {});
  EXPECT_EQ(result.targets[0].measured, 0.5);  // a negative value is no chi-square value
  EXPECT_EQ(result.targets[1].measured, 0.75);
  EXPECT_EQ(result.targets[2].measured, 0.75);
  EXPECT_EQ(result.targets[3].measured, 1.0);
  EXPECT_EQ(result.targets[3].n, 48);  // NaN is no trial of this target
  for (const size_t of_all : {0, 1, 2}) EXPECT_EQ(result.targets[of_all].n, 64) << "infinity is one";
  EXPECT_EQ(result.num_trials, 64);
}

// Of five trials that yield 0, 1, 2, infinity, -1 and NaN.
TEST(DecideCheck, MeanPitCountsWhatIsNoNumberOfTheLawAsBeyondIt) {
  Target pit = MeasuredMean("mean PIT");
  pit.kind = Target::Kind::kMeanPit;
  pit.degrees_of_freedom = 2;  // F(x) = 1 - exp(-x / 2)
  Target bounded = MeasuredMean("difference", 1);
  bounded.kind = Target::Kind::kBoundedMean;
  bounded.range = {-1.0, 1.0};
  Check check;
  check.targets = {pit, bounded};
  check.limits = {6, 6, 6};
  const std::vector<double> values = {0.0, 1.0, 2.0, std::numeric_limits<double>::infinity(), -1.0, kNaN};
  check.trial = [values](const StreamName& name) -> Outcome {
    return {values[name.trial], name.trial == 0 ? -1.0 : 1.0};
  };
  const CheckResult result = DecideCheck(check, {});
  EXPECT_EQ(result.targets[0].n, 5);
  EXPECT_NEAR(result.targets[0].measured,
              (0.0 + 1.0 - std::exp(-0.5) + 1.0 - std::exp(-1.0) + 1.0 + 1.0) / 5.0, 1e-12);
  EXPECT_EQ(result.targets[1].n, 6);
  EXPECT_NEAR(result.targets[1].measured, 4.0 / 6.0, 1e-12);
  EXPECT_GE(result.targets[1].interval.lower, -1.0);
  EXPECT_LT(result.targets[1].interval.lower, result.targets[1].measured);
}

TEST(DecideCheck, ABoundedMeanOfZerosIsZero) {
  Check check;
  check.limits = {0, 500, 500};
  check.trial = [](const StreamName&) -> Outcome { return {0.0}; };
  Target difference = ClaimedMean("difference", 0.0, {-0.05, 0.05});
  difference.kind = Target::Kind::kBoundedMean;
  difference.range = {-1.0, 1.0};
  check.targets = {difference};
  const CheckResult result = DecideCheck(check, {});
  EXPECT_EQ(result.targets[0].measured, 0.0);
  EXPECT_NEAR(result.targets[0].interval.lower, -result.targets[0].interval.upper, 1e-3);
}

TEST(DecideCheck, MeansAreLookedAtOnceAtTheEnd) {
  Check check;
  check.limits = {0, 1'000, 1'000};
  check.trial = [](const StreamName& name) -> Outcome { return {RandomStream(name).Normal()}; };
  check.targets = {ClaimedMean("mean", 0.0, {-0.5, 0.5})};
  const CheckResult result = DecideCheck(check, {});
  EXPECT_EQ(result.num_trials, 1'000);
  EXPECT_EQ(result.verdict, Verdict::kHolds);
  EXPECT_NEAR(result.targets[0].interval.upper - result.targets[0].measured, 1.96 / std::sqrt(1'000.0), 0.01);

  // Student's 97.5 % quantile of four degrees of freedom, tabulated; that of five is 2.571.
  const CheckResult of_five = DecideCheck(CountingCheck({MeasuredMean("mean")}, {0, 5, 5}), {});
  EXPECT_NEAR(of_five.targets[0].interval.upper, 2.0 + 2.776 * std::sqrt(2.5 / 5.0), 1e-3);

  CoverageCount covered;  // a mean whose interval is Student's covers at its confidence
  check.limits = {0, 5, 5};
  for (std::uint32_t repetition = 0; repetition < 4'000; ++repetition) {
    CheckRun run;
    run.condition = repetition;
    covered.Add(DecideCheck(check, run).targets[0].interval.Contains(0.0));
  }
  EXPECT_TRUE(covered.Admits(0.95)) << covered;
}

// A target that is claimed if stated: of 500 trials and more that say nothing of it nothing is claimed, and
// one that speaks later claims it again. Catches a silent target that keeps its check undecided, one that
// holds, and one that is let off although it was stated now and then.
TEST(DecideCheck, WhatNobodyStatesIsNotClaimed) {
  const auto decide = [](std::uint32_t every, bool has_other) {
    Check check;
    check.not_stated = "no answer states it";
    check.limits = {1'000, 2'000, 2'000};
    check.targets = {IfStated(RateWithin(0.9, 1.0))};
    if (has_other) check.targets.push_back(ClaimedRate("other", 1.0, {0.9, 1.0}, 1));
    check.trial = [every](const StreamName& name) -> Outcome {
      return {every > 0 && name.trial % every == 0 ? 0.0 : kNaN, 1.0};
    };
    return DecideCheck(check, {});
  };
  const CheckResult silent = decide(0, false);
  EXPECT_EQ(silent.not_possible, "no answer states it in 500 trials");
  EXPECT_FALSE(silent.verdict);
  EXPECT_TRUE(silent.targets.empty());
  const CheckResult beside = decide(0, true);
  EXPECT_EQ(beside.not_possible, "");
  EXPECT_EQ(beside.verdict, Verdict::kHolds) << "the other target decides";
  EXPECT_EQ(beside.num_trials, 1'000 + 220) << "the first look after the least number";
  EXPECT_FALSE(beside.targets[0].verdict);
  EXPECT_EQ(decide(100, true).verdict, Verdict::kDoesNotHold) << "stated rarely, and always wrong";
  EXPECT_EQ(decide(5'000, true).verdict, Verdict::kUndecided) << "stated once: too seldom to decide";
}

// The truth lies on the border of what is allowed: "does not hold" is a false alarm, and an interval of fixed
// n that is looked at again and again raises it far too often.
TEST(DecideCheck, LookingOftenDoesNotInflateErrors) {
  constexpr double kBorder = 0.9;
  const Check check = BernoulliCheck(kBorder, RateWithin(kBorder, 1.0), {0, 4'000, 4'000});
  CoverageCount alarms, naive_alarms;
  for (std::uint32_t repetition = 0; repetition < 2'000; ++repetition) {
    CheckRun run;
    run.condition = repetition;
    alarms.Add(DecideCheck(check, run).verdict == Verdict::kDoesNotHold);
    bool naive_alarm = false;
    std::int64_t successes = 0;
    for (std::uint32_t trial = 0; trial < 4'000 && !naive_alarm; ++trial) {
      successes += check.trial({run.seed, run.condition, trial, 0})[0] != 0.0;
      const std::int64_t n = trial + 1;
      if (n % 50 == 0) naive_alarm = ExactBinomialInterval(successes, n, 0.95).upper < kBorder;
    }
    naive_alarms.Add(naive_alarm);
  }
  EXPECT_LE(alarms.interval().upper, 0.05) << alarms;
  EXPECT_GT(naive_alarms.interval().lower, 0.07) << naive_alarms;
  std::cout << "sequential: " << alarms << "\nfixed-n interval, looked at every 50: " << naive_alarms << "\n";
}

}  // namespace
}  // namespace rcme
