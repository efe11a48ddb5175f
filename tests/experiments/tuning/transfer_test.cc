#include "experiments/tuning/transfer.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/tuning/transfer_output.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/in_memory.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

// Two factors, four conditions.
StudyPlan FourConditions(const std::string& design = "") {
  std::string yaml = TunedYaml(
      "  target: failure\n"
      "  at_most: 0.35\n"
      "  max_refusal: 0.95\n"
      "  explore: 5\n"
      "  calibrate: 12\n"
      "  verify: 8\n"
      "  options: {mu: [1, 2, 3, 6]}\n");
  const std::string before = "factors:\n";
  yaml.insert(yaml.find(before) + before.size(), "  sigma_px: [0.5, 2]\n");
  if (!design.empty()) {
    yaml.insert(yaml.find("factors:"), "design: " + design + "\n");
    yaml.insert(yaml.find("sigma_px: 0.5}") + 13, ", outlier_ratio: 0.0");
  }
  return MakePlan(ParseStudy(yaml, "four.yaml"));
}

TransferResult Transfer(const StudyPlan& plan, const std::string& by, int num_threads = 2) {
  return MeasureTransferInMemory(plan, MakeTunedSettings(plan), by, num_threads);
}

std::vector<std::string> Words(const TransferResult& result) {
  std::vector<std::string> words;
  for (const Family& family : result.families) words.push_back(family.words);
  return words;
}

TEST(Transfer, FamiliesAreTheConditions) {
  const TransferResult result = Transfer(FourConditions(), "");
  EXPECT_EQ(Words(result), (std::vector<std::string>{
                               "sigma_px = 0.5, outlier_ratio = 0", "sigma_px = 0.5, outlier_ratio = 0.3",
                               "sigma_px = 2, outlier_ratio = 0", "sigma_px = 2, outlier_ratio = 0.3"}));
  EXPECT_EQ(result.families[2].conditions, (std::vector<std::uint32_t>{2}));
}

TEST(Transfer, FamiliesOfAFactorTakeConditionsTogether) {
  const TransferResult result = Transfer(FourConditions(), "outlier_ratio");
  EXPECT_EQ(Words(result), (std::vector<std::string>{"outlier_ratio = 0", "outlier_ratio = 0.3"}));
  EXPECT_EQ(result.families[0].conditions, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(result.families[1].conditions, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(result.verified[0][0].n, 16);
}

TEST(Transfer, FamiliesOfAOneAtATimeStudySayWhatDiffers) {
  const TransferResult result = Transfer(FourConditions("one_at_a_time"), "");
  EXPECT_EQ(Words(result), (std::vector<std::string>{"base", "sigma_px = 2", "outlier_ratio = 0.3"}));
}

// A family's choice is what a tuning on its conditions alone would choose.
TEST(Transfer, AFamilyIsTunedOnItsOwnConditionsAlone) {
  const StudyPlan plan = FourConditions();
  const TransferResult result = Transfer(plan, "outlier_ratio");
  for (size_t f = 0; f < 2; ++f) {
    StudyPlan alone = plan;
    alone.conditions = {plan.conditions[f], plan.conditions[2 + f]};
    const TuneResult tuned = TuneInMemory(alone, MakeTunedSettings(alone), Unreached::kVerifyAll, 2);
    EXPECT_EQ(result.families[f].choice.setting, tuned.choice.setting);
    EXPECT_EQ(result.families[f].choice.path, tuned.choice.path);
    EXPECT_EQ(result.families[f].choice.why, tuned.choice.why);
    EXPECT_EQ(Text(result.verified[f]), Text(tuned.verified));
  }
  EXPECT_NE(Text(result.verified[0]), Text(result.verified[1]));
}

TEST(Transfer, DoesNotDependOnThreads) {
  const StudyPlan plan = FourConditions();
  EXPECT_EQ(MakeTransferResult(plan, MakeTunedSettings(plan), Transfer(plan, "", 1)).json,
            MakeTransferResult(plan, MakeTunedSettings(plan), Transfer(plan, "", 3)).json);
}

TEST(Transfer, WhatHasNoPromiseOrNoOtherFamilyIsRefused) {
  StudyPlan plan = FourConditions();
  EXPECT_TRUE(ThrowsInputError([&] { Transfer(plan, "scene"); },
                               {"--by scene", "no such factor", "sigma_px, outlier_ratio"}));
  StudyPlan one = plan;
  one.conditions.resize(1);
  EXPECT_TRUE(ThrowsInputError([&] { Transfer(one, ""); }, {"one family", "two are needed"}));
  plan.study.tuning->calibrate = 6;  // 0.65^6 = 0.075; two conditions together would do
  EXPECT_TRUE(ThrowsInputError([&] { Transfer(plan, ""); },
                               {"calibrate: 6 in each of 1 conditions", "7 trials would do"}));
  EXPECT_NO_THROW(Transfer(plan, "sigma_px"));
  plan.study.tuning->target = TuneTarget::kRisk;
  EXPECT_TRUE(ThrowsInputError([&] { Transfer(plan, ""); }, {"transfer", "risk"}));
}

TEST(TargetVerdict, TheWholeIntervalOnOneSideOfTheLimit) {
  Tuning tuning;
  tuning.target = TuneTarget::kFailure;
  tuning.at_most = 0.1;
  tuning.max_refusal = 1.0;
  // 95 % intervals of 100: 4 [1.1, 9.9], 5 [1.6, 11.3], 17 [10.2, 25.8], 16 [9.4, 24.7] %.
  EXPECT_EQ(DecideSetting(tuning, {100, 4, 90, 0, 0}), Verdict::kHolds);
  EXPECT_EQ(DecideSetting(tuning, {100, 5, 0, 0, 0}), Verdict::kUndecided);
  EXPECT_EQ(DecideSetting(tuning, {100, 16, 0, 0, 0}), Verdict::kUndecided);
  EXPECT_EQ(DecideSetting(tuning, {100, 17, 0, 0, 0}), Verdict::kDoesNotHold);
  tuning.target = TuneTarget::kFalseRefusal;
  EXPECT_EQ(DecideSetting(tuning, {1000, 900, 4, 100, 4}), Verdict::kHolds);
  EXPECT_EQ(DecideSetting(tuning, {1000, 0, 0, 0, 0}), Verdict::kUndecided) << "no trial is good";
}

// The target limits refusals as well: a setting that refuses everything never fails.
TEST(TargetVerdict, RefusalsAreLimitedToo) {
  Tuning tuning;
  tuning.target = TuneTarget::kFailure;
  tuning.at_most = 0.1;
  tuning.max_refusal = 0.5;
  EXPECT_EQ(DecideSetting(tuning, {100, 0, 100, 0, 0}), Verdict::kDoesNotHold);
  EXPECT_EQ(DecideSetting(tuning, {100, 0, 50, 0, 0}), Verdict::kUndecided);
  EXPECT_EQ(DecideSetting(tuning, {100, 0, 20, 0, 0}), Verdict::kHolds);
  EXPECT_EQ(DecideSetting(tuning, {100, 30, 50, 0, 0}), Verdict::kDoesNotHold);
}

TEST(TransferOutput, CellsAndCountsOfTheOthers) {
  const StudyPlan plan = FourConditions();
  TransferResult result;
  result.settings = {"mu = 1", "mu = 2", "mu = 3", "mu = 6"};
  result.families = {{"easy", {0}, {}}, {"hard", {1}, {}}, {"odd", {2}, {}}};
  result.families[0].choice.setting = 1;
  result.families[1].choice.why = "out of reach";
  result.families[2].choice.setting = 3;
  const SettingCount none{100, 0, 0, 100, 0}, many{100, 90, 0, 10, 0}, some{100, 30, 0, 70, 0};
  result.verified = {{none, none, none, none}, {many, many, many, many}, {none, some, none, none}};
  const std::string table = MakeTransferResult(plan, MakeTunedSettings(plan), result).text;
  EXPECT_NE(table.find("none: out of reach"), std::string::npos) << table;
  const auto json = nlohmann::json::parse(MakeTransferResult(plan, MakeTunedSettings(plan), result).json);
  ASSERT_EQ(json["cells"].size(), 6u);  // of two families
  EXPECT_EQ(json["cells"][1]["verified_on"], 1);
  EXPECT_EQ(json["cells"][1]["verdict"], "does not hold");
  EXPECT_EQ(json["cells"][1]["rate"]["value"], 0.9);
  EXPECT_EQ(json["cells"][2]["verdict"], "undecided");
  EXPECT_EQ(json["cells"][3]["tuned_on"], 2);
  EXPECT_EQ(json["cells"][3]["verdict"], "holds");
  EXPECT_EQ(json["families"][0]["levels"][0], "2");
  EXPECT_TRUE(json["families"][1]["levels"].is_null());
}

}  // namespace
}  // namespace rcme
