#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/core/files/sha256.h"
#include "experiments/statistics/preregistration_output.h"
#include "experiments/statistics/summary_quantities.h"
#include "experiments/study/study_lock.h"
#include "stats/paired.h"
#include "stats/population_rate.h"
#include "stats/score_mean.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

using testing::HasSubstr;

TEST(StatableQuantities, AreRatesAndScoresOfTheSummary) {
  for (const std::string& name : StatableQuantities()) {
    const auto found = std::ranges::find(TrialQuantities(), name, &TrialQuantity::name);
    ASSERT_NE(found, TrialQuantities().end()) << name;
    EXPECT_TRUE(found->kind == SummaryRow::Kind::kRate || found->kind == SummaryRow::Kind::kScore) << name;
  }
}

// At the bounds themselves: "at least" and "at most" hold there, a difference has to pass its margin.
TEST(DecideHypothesis, ByWhereTheWholeIntervalLies) {
  using enum StatedDirection;
  using enum HypothesisVerdict;
  const auto decide = [](StatedDirection direction, double bound, double lower, double upper) {
    StatedHypothesis hypothesis;
    hypothesis.direction = direction;
    hypothesis.bound = bound;
    return Decide(hypothesis, {lower, upper});
  };
  EXPECT_EQ(decide(kAtLeast, 0.9, 0.9, 0.95), kHolds);
  EXPECT_EQ(decide(kAtLeast, 0.9, 0.89, 0.95), kOpen);
  EXPECT_EQ(decide(kAtLeast, 0.9, 0.8, 0.9), kOpen);
  EXPECT_EQ(decide(kAtLeast, 0.9, 0.8, 0.89), kDoesNotHold);
  EXPECT_EQ(decide(kAtMost, 0.1, 0.0, 0.1), kHolds);
  EXPECT_EQ(decide(kAtMost, 0.1, 0.1, 0.2), kOpen);
  EXPECT_EQ(decide(kAtMost, 0.1, 0.11, 0.2), kDoesNotHold);
  EXPECT_EQ(decide(kLower, 0.02, -0.1, -0.03), kHolds);
  EXPECT_EQ(decide(kLower, 0.02, -0.1, -0.02), kOpen);
  EXPECT_EQ(decide(kLower, 0.02, -0.02, 0.1), kDoesNotHold);
  EXPECT_EQ(decide(kHigher, 0.02, 0.03, 0.1), kHolds);
  EXPECT_EQ(decide(kHigher, 0.02, 0.02, 0.1), kOpen);
  EXPECT_EQ(decide(kHigher, 0.02, -0.1, 0.02), kDoesNotHold);
  EXPECT_EQ(decide(kNotLower, 0.02, -0.01, 0.1), kHolds);
  EXPECT_EQ(decide(kNotLower, 0.02, -0.02, 0.1), kOpen);
  EXPECT_EQ(decide(kNotLower, 0.02, -0.1, -0.02), kDoesNotHold);
  EXPECT_EQ(decide(kNotHigher, 0.02, -0.1, 0.01), kHolds);
  EXPECT_EQ(decide(kNotHigher, 0.02, -0.1, 0.02), kOpen);
  EXPECT_EQ(decide(kNotHigher, 0.02, 0.02, 0.1), kDoesNotHold);
}

// Hand-made records of the small study: two conditions, "standard" and "ours".
class PreregistrationTest : public SummarizedRun {
 protected:
  PreregistrationTest() {
    study_ = SmallStudy();
    study_.trials = kTrials;
  }

  void State(const std::string& hypotheses) {
    study_ = ParseStudy(
        SmallStudyYaml() +
            "ademp: {aims: a, data: b, estimands: c, methods: d, performance: e}\nhypotheses:\n" + hypotheses,
        "s.yaml");
    study_.trials = kTrials;
  }
  // Of each condition so many trials; the first `num_failed` of standard fail, and none of ours. With a lock
  // of the study of `locked_trials` per condition.
  Preregistration Run(std::uint32_t num_trials, std::uint32_t num_failed, int locked_trials = kTrials) {
    StudyPlan plan = MakePlan(study_);
    if (stated_trials_ > 0) {
      for (Condition& condition : plan.conditions) condition.num_trials = stated_trials_;
    }
    Study locked = study_;
    locked.trials = locked_trials;
    if (is_locked_) plan.lock = ToYaml(MakeLock(MakePlan(locked)));
    const std::string path = folder_.Path("prereg" + std::to_string(num_runs_++));
    {
      ResultStore store = ResultStore::OpenForRun(path, plan);
      std::vector<TrialRecord> records;
      for (std::uint32_t c = 0; c < plan.conditions.size(); ++c) {
        for (std::uint32_t trial = 0; trial < num_trials; ++trial) {
          for (std::uint32_t e = 0; e < 2; ++e) {
            records.push_back(Motion(trial, e == 0 && trial < num_failed ? 90.0 : 1.0, 1.0, 5.0));
            records.back().condition = c;
            records.back().estimator = e;
          }
        }
      }
      AddRecords(store, records);
    }
    return *DecidePreregistered(ResultStore::OpenForReading(path), path);
  }

  static constexpr int kTrials = 100;
  bool is_locked_ = true;
  int stated_trials_ = 0;  // what the file says of every condition, if it is not as in the study
  int num_runs_ = 0;
};

TEST_F(PreregistrationTest, IntervalsHoldTogether) {
  State(
      "  - {quantity: failure, estimator: ours, against: standard, direction: lower, margin: 0.02}\n"
      "  - {quantity: failure, estimator: standard, at_most: 0.05, where: {outlier_ratio: 0.3}}\n");
  const Preregistration decided = Run(100, 10);
  EXPECT_TRUE(decided.is_locked);
  EXPECT_TRUE(decided.deviations.empty());
  EXPECT_DOUBLE_EQ(decided.confidence_each, 0.975);
  ASSERT_EQ(decided.hypotheses.size(), 2u);
  const PairedCounts counts{0, 0, 20, 180};
  EXPECT_EQ(decided.hypotheses[0].n, 200);
  EXPECT_EQ(decided.hypotheses[0].num_conditions, 2);
  EXPECT_DOUBLE_EQ(decided.hypotheses[0].value, -0.1);
  EXPECT_EQ(decided.hypotheses[0].interval.upper, RiskDifferenceInterval(counts, 0.975).upper);
  EXPECT_EQ(decided.hypotheses[0].verdict, HypothesisVerdict::kHolds);
  EXPECT_EQ(decided.hypotheses[1].n, 100);
  EXPECT_EQ(decided.hypotheses[1].interval.lower, ExactBinomialInterval(10, 100, 0.975).lower);
  // 95 % alone would exclude it: [4.9, 17.6] does not, by little, and 97.5 % less so.
  EXPECT_EQ(decided.hypotheses[1].verdict, HypothesisVerdict::kOpen);
}

TEST_F(PreregistrationTest, AnUnfinishedRunLeavesThemOpen) {
  State("  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  const DecidedHypothesis decided = Run(99, 0).hypotheses[0];
  EXPECT_EQ(decided.verdict, HypothesisVerdict::kOpen);
  EXPECT_EQ(decided.why_open, "198 of 200 trials are done");
  EXPECT_EQ(Run(100, 0).hypotheses[0].verdict, HypothesisVerdict::kHolds);
}

// A file may say that a pass has 2^31 - 1 trials, of each of four conditions: their sum is no negative
// number, which would call the run done.
TEST_F(PreregistrationTest, ACountBeyondIntegersIsNotDone) {
  State("  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  study_.factors[0].levels = {"0.0", "0.1", "0.2", "0.3"};
  study_.trials = 1;
  stated_trials_ = std::numeric_limits<int>::max();
  const DecidedHypothesis decided = Run(100, 0, 1'600'000'000).hypotheses[0];
  EXPECT_EQ(decided.verdict, HypothesisVerdict::kOpen);
  EXPECT_EQ(decided.why_open, "400 of 17179869184 trials are done");
}

// The first forty failed, the others did not; who adds trials until it looks well decides nothing by that.
TEST_F(PreregistrationTest, TrialsThatWereAddedLaterDoNotCount) {
  State("  - {quantity: failure, estimator: standard, at_most: 0.5}\n");
  const Preregistration decided = Run(100, 40, 40);
  EXPECT_EQ(decided.hypotheses[0].n, 80);
  EXPECT_EQ(decided.hypotheses[0].value, 1.0);
  EXPECT_EQ(decided.hypotheses[0].verdict, HypothesisVerdict::kDoesNotHold);
  EXPECT_THAT(decided.deviations, testing::ElementsAre("trials: 100 instead of 40"));
}

// Conditions of a population are the sample.
TEST_F(PreregistrationTest, OfAPopulationTheConditionsCount) {
  State("  - {quantity: failure, estimator: standard, at_most: 0.5}\n");
  study_.factors.clear();
  study_.population = Population();
  study_.population->number = 16;
  study_.population->keys = {{"outlier_ratio", {}, {DrawnRange::Kind::kUniform, 0.0, 0.3, {}}}};
  study_.trials = 10;
  const DecidedHypothesis decided = Run(10, 1, 10).hypotheses[0];
  const std::vector<ConditionCount> counts(16, {1, 10});
  const PopulationRate rate = MeasurePopulationRate(counts);
  EXPECT_EQ(decided.num_conditions, 16);
  EXPECT_EQ(decided.n, 160);
  EXPECT_EQ(decided.interval.upper, rate.interval.upper);
}

TEST_F(PreregistrationTest, ScoresAndScenesHaveTheIntervalsOfBetting) {
  State("  - {quantity: auc_10_deg, estimator: ours, against: standard, direction: higher}\n");
  DecidedHypothesis decided = Run(100, 10).hypotheses[0];
  EXPECT_NEAR(decided.value, 0.09, 1e-12);  // 0.9 where the other has 0
  EXPECT_EQ(decided.n, 200);
  EXPECT_EQ(decided.verdict, HypothesisVerdict::kHolds);
  State("  - {quantity: failure, estimator: standard, at_most: 0.5}\n");
  study_.repeats_per_scene = 10;
  decided = Run(100, 10).hypotheses[0];
  EXPECT_EQ(decided.n, 20) << "scenes";
  EXPECT_DOUBLE_EQ(decided.value, 0.1);
}

// Scenes of a population that all agree do not show that no other draw differs.
TEST_F(PreregistrationTest, DrawsThatAgreeDecideNoRareFailure) {
  for (const char* hypothesis : {"  - {quantity: failure, estimator: standard, at_most: 0.001}\n",
                                 "  - {quantity: auc_20_deg, estimator: standard, at_least: 0.949}\n"}) {
    State(hypothesis);
    study_.factors.clear();
    study_.population = Population();
    study_.population->number = 8;
    study_.population->keys = {{"outlier_ratio", {}, {DrawnRange::Kind::kUniform, 0.0, 0.3, {}}}};
    study_.trials = 4;
    study_.repeats_per_scene = 2;
    const DecidedHypothesis decided = Run(4, 0, 4).hypotheses[0];
    EXPECT_EQ(decided.n, 16) << "scenes";
    EXPECT_EQ(decided.verdict, HypothesisVerdict::kOpen) << hypothesis;
    EXPECT_GT(decided.interval.upper - decided.interval.lower, 0.2) << hypothesis;
  }
}

// Two conditions of the same scenes say what one says, if their outcomes are the same.
TEST_F(PreregistrationTest, CommonScenesAreNotCountedTwice) {
  State("  - {quantity: failure, estimator: standard, at_most: 0.5}\n");
  study_.common_scenes = true;
  const DecidedHypothesis both = Run(100, 10).hypotheses[0];
  ScoreMean of_scenes;
  of_scenes.Add(1.0, 10);
  of_scenes.Add(0.0, 90);
  EXPECT_EQ(both.n, 200);
  EXPECT_DOUBLE_EQ(both.value, 0.1);
  EXPECT_NEAR(both.interval.lower, of_scenes.Sequence().lower, 1e-9);
  EXPECT_NEAR(both.interval.upper, of_scenes.Sequence().upper, 1e-9);
}

TEST_F(PreregistrationTest, IsSaidForPeople) {
  State("  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  const std::string locked = PreregistrationAsText(Run(100, 0));
  EXPECT_THAT(locked, HasSubstr("Decided before the run (locked at "));
  EXPECT_THAT(locked, HasSubstr("failure of ours is at most 0.5"));
  EXPECT_THAT(locked, HasSubstr("holds"));
  is_locked_ = false;
  EXPECT_THAT(PreregistrationAsText(Run(100, 0)), HasSubstr("It has no lock"));
  study_.hypotheses.clear();
  StudyPlan plan = MakePlan(study_);
  EXPECT_FALSE(DescribePreregistered(Describe(plan), "run"));
}

// Wide regions cover: beside each coverage stands how wide they are, of both estimators.
TEST_F(PreregistrationTest, ACoverageComesWithItsSharpness) {
  State(
      "  - {quantity: nees_coverage, estimator: ours, at_least: 0.9}\n"
      "  - {quantity: nees_coverage, estimator: ours, against: standard, direction: not_lower, margin: 0.1}\n"
      "  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  const Preregistration decided = Run(100, 10);
  const std::string text = PreregistrationAsText(decided);
  // Trial k states k + 1 times the bound (Motion), so the 100-th of 200 is 50.
  const std::string ours = "   ours: stated sd 50 times the least possible (median)\n";
  EXPECT_THAT(text, HasSubstr("n = 200\n" + ours + "\n2. "));
  EXPECT_THAT(text, HasSubstr(ours + "   standard: stated sd 50 times the least possible (median)\n\n3. "));
  const auto hypotheses = PreregistrationAsJson(decided)["hypotheses"];
  EXPECT_EQ(hypotheses[0]["sharpness"]["sd_over_crb"], 50.0);
  EXPECT_TRUE(hypotheses[0]["sharpness_against"].is_null());
  EXPECT_TRUE(hypotheses[2]["sharpness"].is_null());
}

TEST_F(PreregistrationTest, AForgedLockIsRefused) {
  State("  - {quantity: failure, estimator: ours, at_most: 0.5}\n");
  RunDescription run = Describe(MakePlan(study_));
  run.lock = ToYaml(MakeLock(MakePlan(study_)));
  EXPECT_TRUE(DescribePreregistered(run, "run"));
  run.lock.replace(run.lock.find("at_most: 0.5"), 12, "at_most: 0.6");
  EXPECT_TRUE(ThrowsInputError([&] { DescribePreregistered(run, "run"); }, {"run (its lock)", "sha256"}));
  run.lock = ToYaml(StudyLock{"now", "rcme", Sha256(""), ""});
  EXPECT_TRUE(
      ThrowsInputError([&] { DescribePreregistered(run, "run"); }, {"run (its lock)", "text is missing"}));
}

}  // namespace
}  // namespace rcme
