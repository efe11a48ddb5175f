#include "experiments/audit/model_choice/choice_output.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

// Planar truth of ten trials, seven called planar and three general, by the first criterion alone.
ChoiceCounts SomeCounts() {
  ChoiceCounts counts{{"outlier_ratio"}, {{{"0.3"}, std::vector<ConfusionMatrix>(CriterionNames().size())}}};
  auto& row = counts.groups[0].matrices[0][static_cast<size_t>(TrueKind::kPlanar)];
  row[static_cast<size_t>(SceneVerdict::kPlanar)] = 7;
  row[static_cast<size_t>(SceneVerdict::kGeneral)] = 3;
  return counts;
}

// Clopper-Pearson of 7 of 10 is [0.3475, 0.9333], of 0 of 10 [0, 0.3085].
TEST(ChoiceOutput, TableHasARowForEachTruthThereIs) {
  const std::string table = MakeChoiceResult(MakePlan(SmallStudy()), SomeCounts()).text;
  EXPECT_NE(table.find("outlier_ratio = 0.3"), std::string::npos) << table;
  EXPECT_NE(table.find("70.0 % [34.8, 93.3]"), std::string::npos) << table;
  EXPECT_NE(table.find("0.0 % [0.0, 30.8]"), std::string::npos) << table;
  EXPECT_EQ(table.find("borderline"), std::string::npos) << table;
  EXPECT_NE(table.find("no_verdict"), std::string::npos) << table;
}

TEST(ChoiceOutput, CsvHasARowForEachCell) {
  const std::string csv = RenderCsv(MakeChoiceResult(MakePlan(SmallStudy()), SomeCounts()).rows);
  EXPECT_EQ(csv.find("study,condition,outlier_ratio,truth,verdict,estimator,quantity,kind,value,lower,upper,"
                     "standard_error,n,count\n"),
            0u);
  EXPECT_NE(csv.find("\nsmall,0,0.3,planar,planar,orb_slam2,share,rate,0.7,0.34"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",,10,7\n"), std::string::npos);
  const auto num_rows = std::ranges::count(csv, '\n') - 1;
  EXPECT_EQ(num_rows, static_cast<std::ptrdiff_t>(CriterionNames().size() * kTrueKinds.size() * kNumAnswers));
}

TEST(ChoiceOutput, JsonHoldsTheSame) {
  const CommandResult result = MakeChoiceResult(MakePlan(SmallStudy()), SomeCounts());
  const auto json = nlohmann::json::parse(result.json);
  EXPECT_EQ(json["format"], "rcme model choice 2");
  EXPECT_EQ(json["num_conditions"], 2);
  EXPECT_EQ(json["rows"].size(), result.rows.rows.size());
  const auto planar = std::ranges::find_if(json["rows"], [](const auto& row) {
    return row["estimator"] == "orb_slam2" && row["truth"] == "planar" && row["verdict"] == "planar";
  });
  ASSERT_NE(planar, json["rows"].end());
  EXPECT_EQ((*planar)["levels"]["outlier_ratio"], "0.3");
  EXPECT_EQ((*planar)["n"], 10);
  EXPECT_EQ((*planar)["count"], 7);
  EXPECT_NEAR((*planar)["interval"][0].template get<double>(), 0.3475, 1e-4);
  EXPECT_NEAR((*planar)["interval"][1].template get<double>(), 0.9333, 1e-4);
  EXPECT_TRUE(json["rows"][0]["value"].is_null());  // of no trial
}

}  // namespace
}  // namespace rcme
