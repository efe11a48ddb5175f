#include "experiments/tuning/tune_output.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "experiments/tuning/tune_json.h"
#include "stats/intervals.h"
#include "tests/test_support/tuned_study.h"

namespace rcme {
namespace {

using Json = nlohmann::json;

StudyPlan Plan() { return TunedPlan("  at_most: 0.1\n  options: {mu: [1, 2, 3]}\n"); }

// Made up: three settings, two of them on the path, one certified and chosen.
TuneResult Result(const StudyPlan& plan) {
  TuneResult result;
  result.settings = {"mu = 1", "mu = 2", "mu = 3"};
  result.explored = {{50, 0, 30, 20, 10}, {50, 2, 10, 40, 3}, {50, 9, 1, 40, 0}};
  result.calibrated = {{200, 1, 99, 150, 60}, {200, 6, 44, 150, 10}, {200, 30, 4, 150, 0}};
  result.verified = {{100, 0, 50, 70, 20}, {100, 4, 20, 80, 4}, {100, 25, 0, 75, 0}};
  result.choice.setting = 1;
  result.choice.path = {1, 2};
  result.choice.num_certified = 1;
  const SettingPlan settings = MakeTunedSettings(plan);
  result.estimators.push_back({settings.settings[1].spec, {4, 100}, {20, 100}, {24, 100}, {24, 0, 0, 76}});
  result.estimators.push_back({plan.study.estimators[0], {50, 100}, {0, 100}, {50, 100}, {20, 4, 30, 46}});
  return result;
}

EntropyRoc Roc(size_t num_each) {
  EntropyRoc roc{1, "winners", {}, {}, {}};
  for (size_t i = 0; i < num_each; ++i) {
    roc.good.push_back(static_cast<double>(i));
    roc.bad.push_back(static_cast<double>(i) + 0.5 * static_cast<double>(num_each));
  }
  roc.area = MeasureAreaUnderCurve(roc.good, roc.bad);
  return roc;
}

// However lines are broken.
testing::AssertionResult Holds(const std::string& broken, const std::vector<std::string>& fragments) {
  const std::string text = std::regex_replace(broken, std::regex("\\s+"), " ");
  for (const std::string& fragment : fragments) {
    if (text.find(fragment) == std::string::npos)
      return testing::AssertionFailure() << "'" << fragment << "' is not in\n" << text;
  }
  return testing::AssertionSuccess();
}

// The rate that the target limits has its row: 4 failures of the 80 answers that are no refusals.
TEST(TuneOutput, FailuresAmongTheAcceptedAreShownIfTheTargetIsOfThem) {
  StudyPlan plan = Plan();
  EXPECT_EQ(TuneAsTable(plan, Result(plan), {}).find("accepted failure"), std::string::npos);
  plan.study.tuning->target = TuneTarget::kAcceptedFailure;
  EXPECT_TRUE(Holds(TuneAsTable(plan, Result(plan), {}), {"accepted failure 5.00 % [1.38, 12.31] 80"}));
}

TEST(TuneOutput, RatesOfTheJsonAreThoseOfVerification) {
  const StudyPlan plan = Plan();
  const Json json = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), Result(plan), {}));
  ASSERT_EQ(json["settings"].size(), 3u);
  EXPECT_EQ(json["settings"][1]["levels"], Json::array({"2"}));
  EXPECT_EQ(json["settings"][1]["failure"]["value"], 0.04);
  EXPECT_EQ(json["settings"][1]["failure"]["n"], 100);
  EXPECT_EQ(json["settings"][1]["failure"]["upper"], ExactBinomialInterval(4, 100).upper);
  EXPECT_EQ(json["settings"][1]["false_refusal"]["value"], 0.05);
  EXPECT_EQ(json["settings"][1]["false_refusal"]["n"], 80);
  for (const auto& [s, on_path, certified] :
       {std::tuple(0, false, false), {1, true, true}, {2, true, false}}) {
    EXPECT_EQ(json["settings"][s]["is_on_path"], on_path) << s;
    EXPECT_EQ(json["settings"][s]["is_certified"], certified) << s;
  }
  for (const Json& setting : json["settings"])
    EXPECT_EQ(setting["is_on_front"], true);  // 0 / 50, 4 / 20, 25 / 0
  EXPECT_EQ(json["tuned"]["levels"], Json::array({"2"}));
  EXPECT_EQ(json["tuned"]["failure_or_refusal"]["value"], 0.24);
  ASSERT_EQ(json["others"].size(), 1u);
  EXPECT_EQ(json["others"][0]["label"], "standard");
  EXPECT_TRUE(json["others"][0]["levels"].is_null()) << "another estimator has no place among the levels";
}

// Failures / refusals of 100: 2 is beaten by 1, and of equals both are on the front.
TEST(TuneOutput, TheFrontHasTheSettingsThatNoneBeats) {
  const StudyPlan plan = TunedPlan("  at_most: 0.1\n  options: {mu: [1, 2, 3, 4, 5]}\n");
  TuneResult result = Result(plan);
  result.verified = {{100, 4, 20, 80, 0},
                     {100, 4, 21, 80, 0},
                     {100, 0, 50, 50, 0},
                     {100, 4, 20, 80, 0},
                     {100, 5, 20, 80, 0}};
  const Json json = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), result, {}));
  std::string on_front;
  for (const Json& setting : json["settings"]) on_front += setting["is_on_front"] ? '1' : '0';
  EXPECT_EQ(on_front, "10110");
}

// The study's own estimator at its mu, which is the default, 6.
TEST(TuneOutput, AnotherEstimatorHasAPlaceIfItDiffersInTheTunedOptionsAlone) {
  const StudyPlan plan = Plan();
  TuneResult result = Result(plan);
  result.estimators[1].spec = plan.study.estimators[1];
  const auto levels = [&] {
    return Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), result, {}))["others"][0]["levels"];
  };
  EXPECT_EQ(levels(), Json::array({"6"}));
  SetOptions(&result.estimators[1].spec, {{"lambda", "0.9"}});
  EXPECT_TRUE(levels().is_null());
}

TEST(TuneOutput, WithoutAChoiceTheRatesAreThereAllTheSame) {
  const StudyPlan plan = Plan();
  TuneResult result = Result(plan);
  result.choice = {std::nullopt, {1, 2}, 0, 0.0, "out of reach"};
  result.estimators.clear();
  const Json json = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), result, {Roc(10)}));
  EXPECT_TRUE(json["tuned"].is_null());
  EXPECT_EQ(json["settings"][2]["failure"]["value"], 0.25);
  EXPECT_FALSE(json["settings"][1]["is_certified"]);
  EXPECT_TRUE(Holds(TuneAsTable(plan, result, {}), {"Not reached: out of reach"}));
}

TEST(TuneOutput, ARateOfNothingIsNull) {
  EXPECT_TRUE(RateAsJson({0, 0})["value"].is_null());
  EXPECT_EQ(RateAsJson({0, 0})["upper"], 1.0);
  EXPECT_EQ(RateForTable({0, 0}), "-");
  EXPECT_EQ(RateForTable({5, 100}), "5.00 % [1.64, 11.28]");  // Clopper-Pearson 1934
}

TEST(TuneOutput, TheTableSaysWhatWasPromisedAndWhatWasSeen) {
  const StudyPlan plan = Plan();
  const std::string table = TuneAsTable(plan, Result(plan), {Roc(10)});
  // 6 of 200 as tuned, 4 of 100 verified: 3 - 4 = -1; 24 of 100 against 50: -26.
  EXPECT_TRUE(Holds(table, {"3 settings of ours", "Tuned: mu = 2", "1 of 2 settings", "4.00 % [", "3.00 % [",
                            "-1.00", "-26.00 % [", "area under the curve"}));
}

TEST(TuneOutput, OptionsWithoutEffectAreNamed) {
  const StudyPlan plan = Plan();
  TuneResult result = Result(plan);
  EXPECT_EQ(TuneAsTable(plan, result, {}).find("All settings decided alike"), std::string::npos);
  result.verified.assign(3, result.verified[1]);
  EXPECT_TRUE(Holds(TuneAsTable(plan, result, {}), {"All settings decided alike"}));
}

TEST(TuneOutput, TheVerdictTakesBothLimits) {
  const StudyPlan plan = Plan();  // at most 10 % fail, at most 50 % are refused
  TuneResult result = Result(plan);
  const auto verdict = [&](std::int64_t failures, std::int64_t refusals) {
    result.verified[1] = {100, failures, refusals, 50, 0};
    for (const auto& [key, text] : DescribeProvenance(plan, result)) {
      if (key == "verdict") return text;
    }
    return std::string();
  };
  EXPECT_TRUE(Holds(verdict(2, 20), {"the target holds"}));
  EXPECT_TRUE(Holds(verdict(30, 20), {"VIOLATED"}));
  EXPECT_TRUE(Holds(verdict(2, 80), {"VIOLATED"}));
  EXPECT_TRUE(Holds(verdict(9, 20), {"too few to decide"}));
}

TEST(TuneOutput, ProvenanceHasTheFigures) {
  const StudyPlan plan = Plan();
  std::string text;
  for (const auto& [key, value] : DescribeProvenance(plan, Result(plan))) text += key + ": " + value + "\n";
  EXPECT_TRUE(Holds(text, {"study: small", "seed: 3", "tuned: mu = 2", "at most 10 %", "probability 0.05",
                           "failure: rotation error above 3 deg or direction error above 15 deg",
                           "as_tuned: failure 3.00 %", "verified: failure 4.00 % [", "of 100",
                           "false refusal 5.00 %", "of 80", "program: rcme "}));
}

TEST(TuneOutput, TheRiskIsGivenWithItsBound) {
  StudyPlan plan = Plan();
  plan.study.tuning->target = TuneTarget::kRisk;
  TuneResult result = Result(plan);
  result.choice.risk_bound = 0.321;
  EXPECT_TRUE(Holds(TuneAsTable(plan, result, {}), {"verified risk 0.24; bound 0.321"}));
  const Json json = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), result, {}));
  EXPECT_TRUE(json["target"]["at_most"].is_null());
}

TEST(TuneOutput, CurvesRiseFromNothingToEverything) {
  const StudyPlan plan = Plan();
  for (const size_t num_each : {1u, 10u, 150u, 5000u}) {
    const Json json = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), Result(plan), {Roc(num_each)}));
    const Json& curve = json["roc"][0]["curve"];
    EXPECT_LE(curve.size(), 303u);
    EXPECT_EQ(curve.front()[1], 0.0);
    EXPECT_EQ(curve.back()[2], 1.0);
    for (size_t i = 1; i < curve.size(); ++i) {
      EXPECT_GE(curve[i][1], curve[i - 1][1]);
      EXPECT_GE(curve[i][2], curve[i - 1][2]);
    }
  }
  // Of good ones 0 ... 9 and bad ones 5 ... 14, mu = 6 accepts 7 and 2.
  const Json roc = Json::parse(TuneAsJson(plan, MakeTunedSettings(plan), Result(plan), {Roc(10)}))["roc"][0];
  EXPECT_EQ(roc["marks"][0]["words"], "mu = 6");
  EXPECT_EQ(roc["marks"][0]["true_accept_rate"], 0.7);
  EXPECT_EQ(roc["marks"][0]["false_accept_rate"], 0.2);
  EXPECT_EQ(roc["num_good"], 10);
}

TEST(TuneOutput, RepetitionsCountViolationsOfAllRepetitions) {
  const StudyPlan plan = Plan();
  Repetitions repetitions;
  repetitions.num_done = 20;
  repetitions.num_without_choice = 5;
  repetitions.num_violated = 1;
  repetitions.num_undecided = 2;
  repetitions.num_chosen = {0, 14, 1};
  repetitions.reference = Result(plan).verified;
  const std::string table = RepetitionsAsTable(plan, MakeTunedSettings(plan), repetitions);
  EXPECT_TRUE(
      Holds(table, {"tuned 20 times", "Violated: 1 of 20: 5.00 %", "Violated or undecided: 3: 15.00 %",
                    "promised at most 5 %", "without a choice: 5", "mu = 2", "mu = 3"}));
  EXPECT_EQ(table.find("mu = 1 "), std::string::npos) << "never chosen";
}

}  // namespace
}  // namespace rcme
