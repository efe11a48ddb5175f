#include "experiments/statistics/failing_trials.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "parameters/input_error.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

class FailingTrialsTest : public SummarizedRun {
 protected:
  FailingTrials List(const FailureQuery& query) {
    return ListFailingTrials(ResultStore::OpenForReading(folder_.Path("run")), query);
  }
};

// Of ten trials two fail and four are refused (summarized_run.h).
TEST_F(FailingTrialsTest, ListsEveryFailureOnce) {
  const FailingTrials failures = List({});
  EXPECT_EQ(failures.num_found, 2);
  EXPECT_EQ(failures.num_looked_at, 10);
  ASSERT_EQ(failures.listed.size(), 2u);
  for (const FailingTrial& trial : failures.listed) {
    EXPECT_EQ(trial.outcome, "failure");
    EXPECT_EQ(trial.estimator, "standard");
    EXPECT_EQ(trial.levels, std::vector<std::string>{"0"});
  }
  EXPECT_LT(failures.listed[0].trial, failures.listed[1].trial);
}

TEST_F(FailingTrialsTest, EventsConditionsAndLimits) {
  FailureQuery query;
  query.event = "refusal";
  EXPECT_EQ(List(query).num_found, 4);
  query.event = "failure_or_refusal";
  EXPECT_EQ(List(query).num_found, 6);
  query.limit = 3;
  EXPECT_EQ(List(query).num_found, 6);
  EXPECT_EQ(List(query).listed.size(), 3u);
  query.limit = 0;
  EXPECT_EQ(List(query).listed.size(), 6u);
  query.condition = 1;
  EXPECT_EQ(List(query).num_found, 0);
  EXPECT_EQ(List(query).num_looked_at, 0);
  query.condition = std::nullopt;
  query.estimators = {"standard"};
  EXPECT_EQ(List(query).num_found, 6);
}

TEST_F(FailingTrialsTest, WhatThereIsNotIsRefused) {
  FailureQuery query;
  query.event = "failures";
  EXPECT_THROW(List(query), InputError);
  query = {};
  query.estimators = {"sandard"};
  EXPECT_THROW(List(query), InputError);
  query = {};
  query.condition = 2;
  EXPECT_THROW(List(query), InputError);
}

TEST_F(FailingTrialsTest, EveryFormatHasTheSameRows) {
  const FailingTrials failures = List({});
  const CommandResult result = MakeFailuresResult(failures, "my.sqlite");
  const auto json = nlohmann::json::parse(result.json);
  EXPECT_EQ(json["format"], "rcme failures 1");
  EXPECT_EQ(json["rows"].size(), 2u);
  EXPECT_EQ(json["rows"][0]["trial"], failures.listed[0].trial);
  const std::string csv = RenderCsv(result.rows), &table = result.text;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 3);
  EXPECT_NE(table.find("2 of 10 answers"), std::string::npos) << table;
  EXPECT_NE(
      table.find("rcme replay my.sqlite --condition 0 --trial " + std::to_string(failures.listed[0].trial)),
      std::string::npos)
      << table;
}

}  // namespace
}  // namespace rcme
