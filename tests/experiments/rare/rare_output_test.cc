// Rates by hand as text, CSV and JSON.
#include "experiments/rare/rare_output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "experiments/core/table/render_table.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

// Two replicates over the levels 0.5 and 1: rates beyond them of 0.2 and 0.1, and of 0.4 and 0.04.
RareCell CellByHand() {
  RareCell cell;
  cell.condition = 1;
  cell.estimator = 1;
  cell.pilot.levels.levels = {0.5};
  cell.replicates.resize(2);
  cell.replicates[0].estimate = 0.1;
  cell.replicates[0].shares = {0.2, 0.5};
  cell.replicates[0].acceptance = {0.25, 0.5};
  cell.replicates[1].estimate = 0.04;
  cell.replicates[1].shares = {0.4, 0.1};
  cell.replicates[1].acceptance = {0.75, 0.5};
  cell.rate.estimate = 0.07;
  cell.rate.standard_error = 0.03;
  cell.rate.interval = {0.02, 0.2};
  cell.rate.num_values = 700;
  cell.rate.relative_spread = 0.6;
  return cell;
}

TEST(MakeRareRow, KeepsWhatACellSays) {
  RareCell cell = CellByHand();
  cell.rate.doubts = {SplittingDoubt::kMovesStuck};
  const RareRow row = MakeRareRow(cell);
  EXPECT_EQ(row.condition, 1u);
  EXPECT_EQ(row.estimator, 1u);
  EXPECT_EQ(row.estimate, 0.07);
  EXPECT_EQ(row.standard_error, 0.03);
  EXPECT_EQ(row.interval.lower, 0.02);
  EXPECT_EQ(row.num_calls, 700);
  EXPECT_EQ(row.relative_spread, 0.6);
  EXPECT_EQ(row.doubts, std::vector<std::string>{Name(SplittingDoubt::kMovesStuck)});
}

// Fewer than three failures of equal weight are doubted, three are not.
TEST(MakeRareRow, OfStrataDoubtsFewFailures) {
  StratifiedCell cell;
  cell.num_run = 40;
  cell.strata[0].num_trials = 40;
  cell.rate.estimate = 0.01;
  cell.rate.cautious_upper = 0.3;
  cell.rate.interval = {0.001, 0.2};
  cell.rate.num_effective_events = 2.9;
  EXPECT_EQ(MakeRareRow(cell).doubts, std::vector<std::string>{"few_failures"});
  cell.rate.num_effective_events = 3.0;
  EXPECT_TRUE(MakeRareRow(cell).doubts.empty());
  EXPECT_EQ(MakeRareRow(cell).num_calls, 40);
  EXPECT_EQ(MakeRareRow(cell).unseen_up_to, 0.3);
  EXPECT_TRUE(std::isnan(MakeRareRow(cell).relative_spread));
}

// The failures that were seen say nothing of easy trials of which hardly any was run.
TEST(MakeRareRow, OfStrataDoubtsFewEasyTrials) {
  StratifiedCell cell;
  cell.strata[0].num_trials = 40;
  cell.rate.num_effective_events = 10.0;
  cell.rate.interval = {0.001, 0.01};
  cell.rate.cautious_upper = 0.02;
  EXPECT_TRUE(MakeRareRow(cell).doubts.empty());
  cell.rate.cautious_upper = 0.021;
  EXPECT_EQ(MakeRareRow(cell).doubts, std::vector<std::string>{"few_easy_trials"});
}

TEST(MakeRareResult, HasTheRatesBeyondEachLevel) {
  const auto json =
      nlohmann::json::parse(MakeRareResult(MakePlan(SmallStudy()), RareEffort(), {CellByHand()}).json);
  EXPECT_EQ(json.at("format"), "rcme rare 2");
  EXPECT_EQ(json.at("method"), "splitting");
  EXPECT_FALSE(json.contains("risk"));  // of failures there is none
  ASSERT_EQ(json.at("rows").size(), 1u);
  const auto& row = json.at("rows").at(0);
  EXPECT_EQ(row.at("value"), 0.07);
  EXPECT_EQ(row.at("interval"), (std::vector<double>{0.02, 0.2}));
  EXPECT_EQ(row.at("trusted"), 1);
  EXPECT_EQ(row.at("levels"), (nlohmann::json{{"outlier_ratio", "0.3"}}));
  const auto& replicates = json.at("replicates");
  ASSERT_EQ(replicates.size(), 2u);
  EXPECT_EQ(replicates[1].at("estimate"), 0.04);
  EXPECT_EQ(replicates[1].at("replicate"), 1);
  const auto& levels = json.at("error_levels");
  ASSERT_EQ(levels.size(), 2u);
  EXPECT_EQ(levels[0].at("condition"), 1);
  EXPECT_EQ(levels[0].at("error_over_bound"), 0.5);
  EXPECT_NEAR(levels[0].at("rate_beyond").get<double>(), 0.3, 1e-12);
  EXPECT_NEAR(levels[0].at("acceptance").get<double>(), 0.5, 1e-12);
  EXPECT_EQ(levels[1].at("error_over_bound"), 1.0);
  EXPECT_NEAR(levels[1].at("rate_beyond").get<double>(), 0.07, 1e-12);
  EXPECT_NEAR(levels[1].at("standard_error").get<double>(), 0.03, 1e-12);  // |0.1 - 0.04| / 2
}

TEST(MakeStratifiedResult, HasARowForEachStratum) {
  StratifiedCell cell;
  cell.strata[2].num_trials = 40;
  cell.strata[2].num_run = 10;
  cell.strata[2].num_failed = 3;
  const auto json =
      nlohmann::json::parse(MakeStratifiedResult(MakePlan(SmallStudy()), StratifiedEffort(), {cell}).json);
  ASSERT_EQ(json.at("strata").size(), static_cast<size_t>(kNumStrata));
  const auto& stratum = json.at("strata").at(2);
  EXPECT_EQ(stratum.at("one_in"), 4);
  EXPECT_EQ(stratum.at("num_trials"), 40);
  EXPECT_EQ(stratum.at("num_run"), 10);
  EXPECT_EQ(stratum.at("num_failed"), 3);
}

TEST(MakeRareFileTable, SaysWhatIsTrusted) {
  RareRow trusted = MakeRareRow(CellByHand()), doubted = trusted;
  doubted.doubts = {"no_levels", "moves_stuck"};
  const std::string csv = RenderCsv(MakeRareFileTable(MakePlan(SmallStudy()), {}, {trusted, doubted}));
  EXPECT_THAT(csv, testing::HasSubstr(",failure,rate,0.07,0.02,0.2,0.03,700,1,,"));
  EXPECT_THAT(csv, testing::HasSubstr(",failure,rate,0.07,0.02,0.2,0.03,700,0,no_levels moves_stuck,"));
}

// Calls times p e^2 / (1 - p), e the relative error: 700 * 0.07 * (3 / 7)^2 / 0.93.
TEST(RareRow, BruteForceByHand) {
  EXPECT_NEAR(MakeRareRow(CellByHand()).BruteForceShare(), 700.0 * 0.07 * 9.0 / 49.0 / 0.93, 1e-12);
}

}  // namespace
}  // namespace rcme
