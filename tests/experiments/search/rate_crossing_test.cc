#include "experiments/search/rate_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "experiments/search/crossing_output.h"
#include "experiments/study/study_file.h"
#include "tests/test_support/expect_input_error.h"

namespace rcme {
namespace {

Study ParseSolved(const std::string& conditions) {
  return ParseStudy("name: solved\ntrials: 10\n" + conditions +
                        "estimators: [{name: standard, options: {num_iterations: 10}}, {name: msac}]\n",
                    "solved.yaml");
}

// A condition that is planned alone is that of the whole plan: the same scenes and the same estimators.
TEST(MakeConditionPlan, IsTheConditionOfTheWholePlan) {
  for (const char* conditions :
       {"data: {scene: plane, motion: sideways, parallax_deg: 2, num_matches: 20}\n"
        "factors: {outlier_ratio: [0, 0.3], standard.num_iterations: [5, 10]}\n",
        "conditions: {number: 4, ranges: {scene: [plane, uniform_volume], num_matches: [20, 30]}}\n"}) {
    const Study study = ParseSolved(conditions);
    const StudyPlan whole = MakePlan(study);
    ASSERT_EQ(whole.conditions.size(), 4U);
    for (const Condition& condition : whole.conditions) {
      const StudyPlan alone = MakeConditionPlan(study, condition.levels);
      ASSERT_EQ(alone.conditions.size(), 1U);
      EXPECT_EQ(alone.factor_names, whole.factor_names);
      EXPECT_EQ(alone.conditions[0].levels, condition.levels);
      EXPECT_EQ(alone.conditions[0].stream_key, condition.stream_key);
      EXPECT_EQ(alone.conditions[0].num_trials, 10);
      EXPECT_EQ(alone.estimators.size(), 2U);
      EXPECT_EQ(alone.conditions[0].estimators.size(), condition.estimators.size());
    }
  }
}

// The rates of a level do not depend on the conditions beside it.
TEST(FindCrossings, AreTheSameWithFewerConditions) {
  CrossingQuestion question;
  question.setting = "outlier_ratio";
  question.to = 0.9;
  question.rate = 0.5;
  question.num_trials = 100;
  const std::string data = "data: {scene: plane, motion: sideways, num_matches: 20}\n";
  const CrossingAnswer both =
      FindCrossings(ParseSolved(data + "factors: {parallax_deg: [2, 4]}\n"), question, 2, nullptr);
  const CrossingAnswer second =
      FindCrossings(ParseSolved(data + "factors: {parallax_deg: [4]}\n"), question, 1, nullptr);
  ASSERT_EQ(both.crossings.size(), 4U);
  ASSERT_EQ(second.crossings.size(), 2U);
  for (size_t e = 0; e < 2; ++e) {
    EXPECT_EQ(both.crossings[2 + e].levels, std::vector<std::string>{"4"});
    EXPECT_EQ(both.crossings[2 + e].estimate, second.crossings[e].estimate);
    EXPECT_EQ(both.crossings[2 + e].interval.lower, second.crossings[e].interval.lower);
  }
}

std::vector<double> errors_of_answers;

bool NoteError(const TrialRecord& record, const FailureBounds& bounds) {
  if (!HasRefused(record)) errors_of_answers.push_back(record.rotation_error_deg);
  return !(record.direction_error_deg <= bounds.max_direction_error_deg);
}

// The intervals assume independent trials at all levels. Failure bounds and options of estimators do not
// change what is drawn; an answer is here the same for 60 and for 61 samples, unless the trial is another.
TEST(FindCrossings, NoTwoLevelsShareATrial) {
  const Study study = ParseStudy(
      "name: apart\ndata: {scene: plane, motion: sideways, num_matches: 20}\n"
      "failure: {max_direction_error_deg: 3}\nestimators: [{name: standard}]\n",
      "apart.yaml");
  struct Range {
    std::string setting;
    double from, to;
  };
  for (const auto& [setting, from, to] :
       {Range{"max_direction_error_deg", 1, 40}, Range{"standard.num_iterations", 60, 61},
        Range{"outlier_ratio", 0.1, 0.5}}) {
    CrossingQuestion question{.setting = setting, .from = from, .to = to};
    question.is_falling = setting != "outlier_ratio";
    question.event = {"noted", "", NoteError, true};
    question.rate = 0.3;
    question.num_trials = 100;
    errors_of_answers.clear();
    FindCrossings(study, question, 1, nullptr);
    EXPECT_GT(errors_of_answers.size(), 50U) << setting;
    const std::set<double> different(errors_of_answers.begin(), errors_of_answers.end());
    EXPECT_EQ(different.size(), errors_of_answers.size()) << setting;
  }
}

// Which draws are conditions must not depend on the level.
TEST(KeepEstimatorsWithSetting, AreThoseThatHaveTheOption) {
  const Study study = ParseSolved("data: {scene: plane, num_matches: 20}\n");
  CrossingQuestion question;
  question.from = 0.5;
  question.setting = "sigma_px";
  EXPECT_EQ(KeepEstimatorsWithSetting(study, question).estimators.size(), 2U);
  question.from = 10;
  question.setting = "standard.num_iterations";
  const std::vector<EstimatorSpec> kept = KeepEstimatorsWithSetting(study, question).estimators;
  ASSERT_EQ(kept.size(), 1U);
  EXPECT_EQ(kept[0].label, "standard");
  question.setting = "standard.num_iteration";
  EXPECT_TRUE(ThrowsInputError([&] { KeepEstimatorsWithSetting(study, question); },
                               {"--over: ", "'num_iteration'", "num_iterations"}));
}

// Where an estimator refuses, its failures fall again, and the answer warns of it.
TEST(FindCrossings, RefusalsAreCountedAndWarnedOf) {
  const Study study = ParseStudy(
      "name: refusing\ntrials: 10\ndata: {scene: uniform_volume, num_matches: 30, sigma_px: 1}\n"
      "estimators: [{name: rcme_calibrated, options: {max_failure_probability: 0.2}}]\n",
      "refusing.yaml");
  CrossingQuestion question;
  question.setting = "outlier_ratio";
  question.to = 0.9;
  question.rate = 0.3;
  question.num_trials = 60;
  const auto answer = [&](const char* event) {
    question.event = *std::ranges::find(TrialEvents(), event, &TrialEvent::name);
    return FindCrossings(study, question, 2, nullptr);
  };
  const CrossingAnswer failures = answer("failure"), both = answer("failure_or_refusal");
  EXPECT_GT(failures.crossings[0].num_refused, 2);
  EXPECT_EQ(both.crossings[0].num_refused, 0);
  const auto warns = [&](const CrossingAnswer& of) {
    return MakeCrossingsResult(study, question, of).text.find("failure_or_refusal as well") !=
           std::string::npos;
  };
  EXPECT_TRUE(warns(failures));
  EXPECT_FALSE(warns(both));
}

TEST(FindCrossings, RefusesDrawsThatSomeLevelsLack) {
  CrossingQuestion question;
  question.setting = "max_depth_m";
  question.from = 2.0;
  question.to = 10.0;
  question.num_trials = 100;
  const Study study = ParseSolved(
      "conditions: {number: 8, ranges: {scene: uniform_volume, min_depth_m: [1, 3], max_depth_m: [4, 6]}, "
      "given: [min_depth_m < max_depth_m]}\n");
  EXPECT_TRUE(ThrowsInputError([&] { FindCrossings(study, question, 1, nullptr); },
                               {"given", "max_depth_m = 2", "give other --from and --to"}));
}

}  // namespace
}  // namespace rcme
