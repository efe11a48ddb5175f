// A trial that the simulator cannot make in a condition drawn from a population is no error of any command:
// it is counted, and no rate counts it.
#include "experiments/trial/simulate_draw.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/audit/claims/study_claims.h"
#include "experiments/audit/model_choice/choice_output.h"
#include "experiments/audit/validity/study_samples.h"
#include "experiments/rare/rare_output.h"
#include "experiments/run/find_effort.h"
#include "experiments/search/crossing_output.h"
#include "experiments/study/study_file.h"
#include "experiments/tuning/transfer_output.h"
#include "experiments/tuning/tune_output.h"
#include "tests/test_support/in_memory.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr std::int64_t kNumDraws = 8, kTrials = 6;

Study ParseHalf(const std::string& data, const std::string& conditions) {
  return ParseStudy("name: half\nseed: 1\ntrials: 6\ndata: {num_matches: 30, sigma_px: 0.5" + data + "}\n" +
                        conditions +
                        "failure: {max_rotation_error_deg: 1, max_direction_error_deg: 10}\n"
                        "estimators: [{name: standard, options: {num_iterations: 20}}]\n"
                        "tune: {estimator: standard, target: failure, at_most: 0.99, max_refusal: 0.99, "
                        "explore: 2, calibrate: 8, verify: 5, options: {num_iterations: [10, 20]}}\n",
                    "half.yaml");
}

// The two images of a motion of a kilometre see nothing in common.
StudyPlan HalfPlan() {
  return MakePlan(ParseHalf("",
                            "conditions: {number: 8, ranges: {scene: uniform_volume, motion: sideways, "
                            "baseline_m: {any: [0.3, 1000]}}}\n"));
}

bool IsPossible(const Condition& condition) { return condition.levels.back() != "1000"; }

std::int64_t NumPossible(const StudyPlan& plan) { return std::ranges::count_if(plan.conditions, IsPossible); }

// Some trials of its only condition show enough of the plane, others do not.
StudyPlan PlanOfSomeTrials() {
  return MakePlan(ParseHalf("",
                            "conditions: {number: 1, ranges: {scene: plane, motion: sideways, "
                            "max_rotation_deg: {any: [180]}, baseline_m: {any: [0.3]}}}\n"));
}

// The same, chosen.
StudyPlan PlanOfAGrid() {
  return MakePlan(ParseHalf(", scene: plane, motion: sideways, max_rotation_deg: 180, baseline_m: 0.3", ""));
}

TEST(SimulateDraw, HalfOfTheDrawsAreThere) {
  const StudyPlan plan = HalfPlan();
  ASSERT_EQ(std::ssize(plan.conditions), kNumDraws);
  EXPECT_GE(NumPossible(plan), 2);
  EXPECT_LE(NumPossible(plan), 6);
}

TEST(SimulateDraw, SaysHowManyAndWhat) {
  EXPECT_EQ(DescribeNotSimulated(0, 10), "");
  EXPECT_THAT(DescribeNotSimulated(3, 10),
              StartsWith("3 of the 10 trials could not be simulated (not_simulated)"));
}

TEST(SimulateDraw, TuneCountsTheTrialsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  const TuneResult result = TuneInMemory(plan, settings, Unreached::kVerifyAll, 2);
  EXPECT_EQ(result.explored[0].n, NumPossible(plan) * 2);
  EXPECT_EQ(result.calibrated[1].n, NumPossible(plan) * 8);
  EXPECT_EQ(result.verified[1].n, NumPossible(plan) * 5);
  for (const VerifiedEstimator& each : result.estimators) EXPECT_EQ(each.failure.n, NumPossible(plan) * 5);
  EXPECT_THAT(TuneAsTable(plan, result, {}),
              HasSubstr(fmt::format("{} of the {} trials could not be simulated",
                                    (kNumDraws - NumPossible(plan)) * 15, kNumDraws * 15)));
  EXPECT_THROW(CountOutcomes(PlanOfAGrid(), settings, {0, 20}), NotSimulated);
}

TEST(SimulateDraw, EntropiesAreOfTheTrialsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  const EntropiesOfTrials entropies = MeasureEntropies(plan, {0, 3});
  for (const Condition& condition : plan.conditions) {
    const TrialEntropies& first = entropies.at(0).at(3 * condition.index);
    if (IsPossible(condition)) continue;
    EXPECT_FALSE(first.good_winner || first.bad_winner || first.bad_sample);
  }
  EXPECT_THROW(MeasureEntropies(PlanOfAGrid(), {0, 20}), NotSimulated);
}

TEST(SimulateDraw, TransferHasFamiliesWithoutATrial) {
  const StudyPlan plan = HalfPlan();
  const SettingPlan settings = MakeSettingPlan(plan.study, *plan.study.tuning);
  const TransferResult result = MeasureTransferInMemory(plan, settings, "baseline_m", 2);
  ASSERT_EQ(result.families.size(), 2U);
  for (size_t f = 0; f < 2; ++f) {
    const bool is_possible = result.families[f].words == "baseline_m = 0.3";
    EXPECT_EQ(result.verified[f][0].n, is_possible ? NumPossible(plan) * 5 : 0);
    EXPECT_EQ(result.families[f].choice.setting.has_value(), is_possible);
  }
  EXPECT_THAT(MakeTransferResult(plan, settings, result).text,
              HasSubstr("could not be simulated (not_simulated)"));
}

TEST(SimulateDraw, AnAuditNamesConditionsWithoutATrial) {
  const StudyPlan plan = HalfPlan();
  for (const Claim& claim : StudyClaims(plan)) {
    for (const Condition& condition : plan.conditions) {
      const Check& check = claim.checks.at(condition.index);
      if (IsPossible(condition)) {
        EXPECT_THAT(check.not_possible, Not(HasSubstr("not_simulated"))) << claim.id;
      } else {
        EXPECT_THAT(check.not_possible, StartsWith("not_simulated: ")) << claim.id;
      }
    }
  }
}

// One that cannot be simulated says nothing about any statistic.
TEST(SimulateDraw, AnAuditLeavesSingleTrialsOut) {
  const StudyPlan plan = PlanOfSomeTrials();
  const std::vector<Claim> claims = StudyClaims(plan);
  const auto claim = std::ranges::find(claims, "estimator.coverage.standard", &Claim::id);
  ASSERT_NE(claim, claims.end());
  const Check& check = claim->checks.at(0);
  ASSERT_EQ(check.not_possible, "");
  int num_silent = 0, num_not_simulated = 0;
  for (std::uint32_t trial = 0; trial < 40; ++trial) {
    const Outcome outcome = check.trial(NameOfTrial(plan, plan.conditions[0], trial));
    num_silent += std::isnan(outcome.at(1));  // whether a motion is returned
    num_not_simulated += !RunTrialOfDraw(plan, plan.conditions[0], trial).why_not_simulated.empty();
  }
  EXPECT_GT(num_not_simulated, 0);
  EXPECT_LT(num_not_simulated, 40);
  EXPECT_EQ(num_silent, num_not_simulated);
}

TEST(SimulateDraw, AMapHasNoSampleOfThem) {
  const StudyPlan plan = HalfPlan();
  ValidityMapOptions options;
  options.conditions = ListMapConditions(plan);
  options.sigmas_px = {0.5};
  options.nums_points = {8};
  options.trials = 3;
  ASSERT_EQ(std::ssize(options.conditions), kNumDraws);
  for (std::uint32_t cell = 0; cell < kNumDraws; ++cell)
    EXPECT_EQ(RunTrialsOfCell(options, cell, {0, 3}).size(), IsPossible(plan.conditions[cell]) ? 3U : 0U);
  EXPECT_GT(SecondsOfWork(options), 0.0);
}

TEST(SimulateDraw, StrataAreOfTheTrialsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  const std::vector<StratifiedCell> cells = StratifyInMemory(plan, {.num_trials = 200, .run_share = 0.5}, 2);
  for (const StratifiedCell& cell : cells) {
    const bool is_possible = IsPossible(plan.conditions[cell.condition]);
    std::int64_t num_trials = 0;
    for (const StratumCount& count : cell.strata) num_trials += count.num_trials;
    EXPECT_EQ(num_trials, is_possible ? 200 : 0);
    EXPECT_EQ(cell.num_not_simulated, is_possible ? 0 : 200);
    const RareRow row = MakeRareRow(cell);
    EXPECT_EQ(std::ranges::count(row.doubts, "not_simulated"), is_possible ? 0 : 1);
    EXPECT_EQ(std::isnan(row.estimate), !is_possible);
  }
  EXPECT_THAT(StratifiedAsTable(plan, cells),
              HasSubstr(fmt::format("{} of the 1600 trials could not be simulated",
                                    200 * (kNumDraws - NumPossible(plan)))));
}

// Among 200 trials of which some cannot be simulated a rate is over the others.
TEST(SimulateDraw, AStratifiedRateIsOverTheTrialsThatThereAre) {
  const StudyPlan plan = PlanOfSomeTrials();
  const StratifiedCell cell = StratifyInMemory(plan, {.num_trials = 200, .run_share = 1.0}, 2).at(0);
  ASSERT_GT(cell.num_not_simulated, 0);
  ASSERT_LT(cell.num_not_simulated, 200);
  EXPECT_EQ(cell.num_run, 200 - cell.num_not_simulated);
  std::int64_t num_failed = 0;
  for (const StratumCount& count : cell.strata) num_failed += count.num_failed;
  EXPECT_DOUBLE_EQ(cell.rate.estimate,
                   static_cast<double>(num_failed) / static_cast<double>(200 - cell.num_not_simulated));
}

TEST(SimulateDraw, SplittingNamesConditionsWithoutATrial) {
  const StudyPlan plan = HalfPlan();
  const RareEffort effort{{.num_particles = 10, .num_moves = 1, .kept_share = 0.2}, 4};
  const std::vector<RareCell> cells = SplitInMemory(plan, 1, effort, 2);
  for (const RareCell& cell : cells) {
    const bool is_possible = IsPossible(plan.conditions[cell.condition]);
    EXPECT_EQ(cell.num_not_simulated, is_possible ? 0 : FailingMotion::kNumTried);
    EXPECT_EQ(cell.pilot.num_values > 0, is_possible);
    EXPECT_EQ(MakeRareRow(cell).doubts == std::vector<std::string>{"not_simulated"}, !is_possible);
  }
  EXPECT_THAT(RareAsTable(plan, {}, cells), HasSubstr("not trusted: not_simulated:"));
}

// The law is that of the trials that can be simulated, and no move leaves it.
TEST(SimulateDraw, SplittingDrawsWhatCanBeSimulated) {
  const StudyPlan plan = PlanOfSomeTrials();
  const FailingMotion system(plan, plan.conditions[0], 0);
  EXPECT_GT(system.num_not_simulated(), 0);
  EXPECT_LT(system.num_not_simulated(), FailingMotion::kNumTried);
  RandomStream rng({1, 2, 3, 4});
  int num_outside = 0;
  for (int i = 0; i < 100; ++i) {
    MotionInputs state = system.Draw(rng);
    EXPECT_GE(system.Value(state), 0.0);
    for (int move = 0; move < 10; ++move) {
      bool is_local = false;
      num_outside += system.Value(system.Propose(state, 0.5, rng, is_local)) < 0.0;
    }
  }
  EXPECT_GT(num_outside, 0);
}

TEST(SimulateDraw, SolveAsksTheTrialsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  CrossingQuestion question;
  question.setting = "outlier_ratio";
  question.to = 0.9;
  question.rate = 0.5;
  question.num_trials = 120;
  const CrossingAnswer answer = FindCrossings(plan.study, question, 2, nullptr);
  ASSERT_EQ(std::ssize(answer.crossings), kNumDraws);
  for (const Condition& condition : plan.conditions) {
    const RateCrossing& crossing = answer.crossings[condition.index];
    EXPECT_EQ(crossing.num_trials(), IsPossible(condition) ? 120 : 0);
    EXPECT_EQ(std::isnan(crossing.estimate), !IsPossible(condition));
    if (IsPossible(condition)) continue;
    EXPECT_TRUE(std::isinf(crossing.interval.lower) && std::isinf(crossing.interval.upper));
  }
  EXPECT_THAT(MakeCrossingsResult(plan.study, question, answer).text,
              HasSubstr(fmt::format("{} of the 960 trials could not be simulated",
                                    120 * (kNumDraws - NumPossible(plan)))));
}

TEST(SimulateDraw, ModelChoiceCountsTheTrialsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  const ChoiceCounts counts = CountChoicesInMemory(plan, {"baseline_m"}, 2);
  for (const ChoiceGroup& group : counts.groups) {
    std::int64_t n = 0;
    for (const auto& row : group.matrices.front()) {
      for (const std::int64_t count : row) n += count;
    }
    EXPECT_EQ(n, group.levels.front() == "1000" ? 0 : kTrials * NumPossible(plan));
  }
  EXPECT_THAT(MakeChoiceResult(plan, counts).text, HasSubstr("could not be simulated (not_simulated)"));
}

TEST(SimulateDraw, ABudgetIsOfTheProblemsThatThereAre) {
  const StudyPlan plan = HalfPlan();
  EXPECT_EQ(std::ssize(TimedProblems(plan, 0, 3)), 3 * NumPossible(plan));
  EXPECT_THROW(TimedProblems(PlanOfAGrid(), 0, 20), NotSimulated);
}

}  // namespace
}  // namespace rcme
