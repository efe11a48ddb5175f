// What is decided from traces is what plain calls of every setting's estimator do.
#include "experiments/tuning/setting_counts.h"

#include <gtest/gtest.h>

#include <set>

#include "experiments/trial/trial.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"
#include "tests/test_support/test_estimators.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

std::vector<SettingCount> Count(const StudyPlan& plan, size_t condition, TrialRange trials) {
  return CountOutcomes(plan, MakeTunedSettings(plan), trials)[condition];
}

// The study's plan with two estimators: one setting, and the same without its limits.
StudyPlan PlainPlan(const StudyPlan& plan, const EstimatorSpec& setting) {
  Study study = plan.study;
  study.tuning.reset();
  study.estimators = {setting, setting};
  study.estimators[1].label = "without limits";
  const Settings without = {{"inlier_ratio", "inferred"}, {"least_explained_share", "0"}};
  SetOptions(&study.estimators[1], without);
  if (setting.name != "standard") SetOptions(&study.estimators[1], {{"mu", "1000"}});
  return MakePlan(study);
}

SettingCount CountByPlainCalls(const StudyPlan& plan, const EstimatorSpec& setting, size_t condition,
                               TrialRange trials) {
  const StudyPlan plain = PlainPlan(plan, setting);
  SettingCount count;
  for (std::uint32_t trial = trials.first; trial < trials.end; ++trial) {
    const std::vector<TrialRecord> records = RunTrial(plain, plain.conditions[condition], trial).records;
    const bool is_refused = records[0].status != MotionStatus::kOk;
    const bool is_good = HasSucceeded(records[1], plan.study.failure);
    ++count.n;
    count.failures += HasFailed(records[0], plan.study.failure);
    count.refusals += is_refused;
    count.good += is_good;
    count.false_refusals += is_refused && is_good;
  }
  return count;
}

// The study has two conditions: no wrong matches, and 30 %.
void ExpectPlainCounts(const StudyPlan& plan, TrialRange trials) {
  const SettingPlan settings = MakeTunedSettings(plan);
  for (const size_t condition : {0, 1}) {
    std::vector<SettingCount> plain;
    for (const TunedSetting& setting : settings.settings) {
      plain.push_back(CountByPlainCalls(plan, setting.spec, condition, trials));
    }
    EXPECT_EQ(Text(Count(plan, condition, trials)), Text(plain)) << "condition " << condition;
  }
}

TEST(SettingCounts, AreThoseOfPlainCalls) {
  const StudyPlan plan = TunedPlan(
      "  options: {mu: [1, 2.5, 6], lambda: [0.5, 1], selection: [mean_entropy, predictive_likelihood], "
      "significance_level: [0.01, 0.2], chance_significance_level: [off], "
      "observability_significance_level: [off]}\n");  // else hardly a trial fails
  ExpectPlainCounts(plan, {0, 40});
  std::set<std::string> different;
  SettingCount all;
  for (const SettingCount& count : Count(plan, 1, {0, 40})) {
    different.insert(Text({count}));
    all += count;
  }
  EXPECT_GT(different.size(), 10u) << "the options hardly matter";
  for (const std::int64_t count : {all.failures, all.refusals, all.good, all.false_refusals}) {
    EXPECT_GE(count, 10);
  }
}

TEST(SettingCounts, AreThoseOfPlainCallsWhateverTheLoopDecides) {
  ExpectPlainCounts(
      TunedPlan("  options: {num_iterations: [8, 40, 13], early_stop_entropy: [off, 1.5], mu: [2, 4], "
                "quality_test: [as_printed, level_alpha], inlier_ratio: [inferred, 0.7]}\n"),
      {3, 13});
}

// Bounds so narrow that the ending tells which hypothesis won.
StudyPlan PlanWithNarrowBounds(const std::string& options) {
  Study study = TunedPlan("  options: {" + options + "}\n").study;
  study.failure = {0.5, 3.0};
  return MakePlan(study);
}

// Several candidates refined, and a share that the best has to explain: 30 % of the matches are wrong.
TEST(SettingCounts, AreThoseOfPlainCallsWithSeveralRefined) {
  const StudyPlan plan = PlanWithNarrowBounds(
      "num_refined: [1, 4, 20], least_explained_share: [0, 0.55, 0.75], num_iterations: [30]");
  ExpectPlainCounts(plan, {0, 60});
  const std::vector<SettingCount> counts = Count(plan, 1, {0, 60});
  EXPECT_NE(Text({counts[0]}), Text({counts[6]})) << "how many are refined does not matter";
  EXPECT_EQ(counts[0].good, counts[2].good) << "the share is a limit, not a measure of the good";
  EXPECT_GT(counts[2].false_refusals, 3) << "that it refuses good motions is not seen";
}

TEST(SettingCounts, AreThoseOfPlainCallsWhicheverHypothesisWins) {
  const StudyPlan plan = PlanWithNarrowBounds(
      "selection: [mean_entropy, predictive_likelihood], refinement: [none, robust], mu: [4, 6], "
      "num_iterations: [30]");
  ExpectPlainCounts(plan, {0, 20});
  const std::vector<SettingCount> counts = Count(plan, 0, {0, 20});
  EXPECT_NE(Text({counts[0]}), Text({counts[4]})) << "the selection does not matter";
}

TEST(SettingCounts, AreThoseOfPlainCallsAsPrinted) {
  ExpectPlainCounts(
      TunedPlan("  options: {mu: [-6, -3.53, auto], kappa: [0.5, 1]}\n", "printed",
                "  - {name: rcme, label: printed, options: {num_iterations: 20, refinement: mle}}\n"),
      {0, 20});
}

// It has no quality test: what it refuses falsely, it refuses for the size of the inlier set.
TEST(SettingCounts, AreThoseOfPlainCallsOfTheStandardEstimator) {
  const StudyPlan plan = TunedPlan(
      "  options: {num_iterations: [1, 20], lambda: [0.5, 1], inlier_ratio: [inferred, 0.9]}\n", "standard");
  ExpectPlainCounts(plan, {0, 20});
  const std::vector<SettingCount> counts = Count(plan, 1, {0, 20});
  EXPECT_EQ(counts[6].false_refusals, 0);
  EXPECT_GT(counts[7].false_refusals, 3);
}

// An estimator whose loop cannot be taken apart is called setting by setting.
TEST(SettingCounts, AreThoseOfAnEstimatorInOnePiece) {
  AddTestEstimators();
  const std::string options = "  options: {mu: [1, 3, 6], lambda: [0.5, 1]}\n";
  const std::string both =
      "  - {name: whole, options: {num_iterations: 20, reading: rank_aware}}\n"
      "  - {name: counted, options: {num_iterations: 20, reading: rank_aware}}\n";
  const StudyPlan whole = TunedPlan(options, "whole", both), parts = TunedPlan(options, "counted", both);
  EXPECT_EQ(MakeTunedSettings(whole).groups.size(), 2u) << "by what they are without their limits: mu";
  ExpectPlainCounts(whole, {0, 10});
  EXPECT_EQ(Text(Count(whole, 1, {0, 10})), Text(Count(parts, 1, {0, 10})));
}

// Of rcme_calibrated: the limit is decided from one call, whatever its levels are.
TEST(SettingCounts, LevelsOfTheProbabilityLimitShareOneCall) {
  const StudyPlan plan =
      TunedPlan("  options: {max_failure_probability: [0.0001, 0.05, 0.2, 1], max_samples: [70, 100]}\n",
                "rcme_calibrated", "  - {name: rcme_calibrated, options: {max_samples: 100}}\n");
  const SettingPlan settings = MakeTunedSettings(plan);
  EXPECT_EQ(settings.groups.size(), 2u) << "one for each number of samples";
  std::set<std::int64_t> refusals;
  for (const size_t condition : {0, 1}) {
    const std::vector<SettingCount> counts = Count(plan, condition, {0, 12});
    for (size_t s = 0; s < counts.size(); ++s) {
      Study alone = plan.study;
      alone.tuning.reset();
      alone.estimators = {settings.settings[s].spec};
      const StudyPlan plain = MakePlan(alone);
      SettingCount count;
      for (std::uint32_t trial = 0; trial < 12; ++trial) {
        const TrialRecord record = RunTrial(plain, plain.conditions[condition], trial).records[0];
        count.failures += HasFailed(record, alone.failure);
        count.refusals += HasRefused(record);
      }
      EXPECT_EQ(counts[s].failures, count.failures) << condition << " " << s;
      EXPECT_EQ(counts[s].refusals, count.refusals) << condition << " " << s;
      refusals.insert(count.refusals);
    }
  }
  EXPECT_GT(refusals.size(), 1u) << "the limit matters";
}

TEST(SettingCounts, ManyLevelsOfMuTakeNoFurtherTrace) {
  CallCounts& calls = AddTestEstimators();
  const auto num_traces = [&](const std::string& options) {
    const StudyPlan plan =
        TunedPlan("  options: {" + options + "}\n", "counted",
                  "  - {name: counted, options: {num_iterations: 20, reading: rank_aware}}\n");
    calls.traces = calls.estimates = calls.decisions = calls.finishes = 0;
    Count(plan, 0, {0, 7});
    EXPECT_EQ(calls.estimates, 0);
    return calls.traces.load();
  };
  EXPECT_EQ(num_traces("mu: [3]"), 2 * 7);
  const int finishes_of_one = calls.finishes;
  EXPECT_EQ(num_traces("mu: {from: 0, to: 10, step: 0.1}"), 2 * 7);
  EXPECT_EQ(calls.decisions, 2 * 7 * (101 + 1)) << "once per level and trial, and once without limits";
  EXPECT_LT(calls.finishes, 2 * 7 * 20) << "one per winner at most, not one per level";
  EXPECT_GE(calls.finishes, finishes_of_one);
  EXPECT_EQ(num_traces("mu: [3, 4, 5], significance_level: [0.01, 0.05]"), 2 * 2 * 7);
}

TEST(SettingCounts, OfARangeAreTheSumOfItsParts) {
  const StudyPlan plan = TunedPlan("  options: {mu: [1, 2, 6]}\n");
  std::vector<SettingCount> parts = Count(plan, 1, {0, 8});
  const std::vector<SettingCount> rest = Count(plan, 1, {8, 20});
  EXPECT_NE(Text(parts), Text(rest));
  for (size_t s = 0; s < parts.size(); ++s) parts[s] += rest[s];
  EXPECT_EQ(Text(parts), Text(Count(plan, 1, {0, 20})));
}

TEST(SettingCounts, OfOtherSeedsAreOfOtherTrials) {
  const StudyPlan plan = TunedPlan("  options: {mu: [1, 2, 3, 4]}\n");
  StudyPlan other = plan;
  ++other.study.seed;
  EXPECT_NE(Text(Count(plan, 1, {0, 20})), Text(Count(other, 1, {0, 20})));
}

TEST(SettingCounts, SumOverSomeConditions) {
  const SettingCounts counts = {{{10, 1, 2, 6, 1}}, {{10, 3, 4, 5, 2}}, {{10, 7, 0, 2, 0}}};
  EXPECT_EQ(Text(SumOver(counts, {0, 2})), Text({{20, 8, 2, 8, 1}}));
  EXPECT_EQ(SumOver(counts, {1})[0].FalseRefusal().n, 5);
  EXPECT_EQ(SumOver(counts, {1})[0].FalseRefusal().errors, 2);
  EXPECT_EQ(SumOver(counts, {1})[0].Refusal().n, 10);
}

TEST(SettingCounts, WeightedTrialsAreRefused) {
  Study study = TunedPlan("  options: {mu: [3]}\n").study;
  study.data.emplace_back("outlier_count", "bernoulli");
  study.data.emplace_back("tilted_to", "0.6");
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Count(MakePlan(study), 0, {0, 20});
      },
      {"tilted_to", "weighted trials"}));
}

TEST(SettingCounts, RealPairsAreRefused) {
  const TempFolder folder;
  folder.Write("1.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  const StudyPlan plan =
      MakePlan(ParseStudy("data: {scene: match_files, folder: '" + folder.path() +
                              "'}\nestimators: [{name: rcme}]\ntune: {estimator: rcme, options: {mu: [1]}}\n",
                          "real.yaml"));
  EXPECT_TRUE(ThrowsInputError([&] { Count(plan, 0, {0, 1}); }, {"match_files", "--add-estimator"}));
}

}  // namespace
}  // namespace rcme
