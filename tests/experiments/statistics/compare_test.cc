#include "experiments/statistics/compare.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/core/table/render_table.h"
#include "experiments/statistics/comparison_output.h"
#include "experiments/statistics/summarize.h"
#include "experiments/trial/trial_measure.h"
#include "stats/score_mean.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// A trial's outcomes, one letter per estimator: s a success, f a failure, r a refusal, u a motion whose truth
// is not known.
std::vector<TrialRecord> Trial(std::uint32_t condition, std::uint32_t trial, const std::string& outcomes) {
  std::vector<TrialRecord> records;
  for (const char outcome : outcomes) {
    TrialRecord record;
    record.condition = condition;
    record.trial = trial;
    record.estimator = static_cast<std::uint32_t>(records.size());
    record.status = outcome == 'r' ? MotionStatus::kNoCandidate : MotionStatus::kOk;
    record.rotation_error_deg = outcome == 's'   ? 1.0
                                : outcome == 'f' ? 10.0
                                                 : std::numeric_limits<double>::quiet_NaN();
    records.push_back(record);
  }
  return records;
}

class CompareTest : public testing::Test {
 protected:
  // The trials of condition 0, each as often as it says.
  void Write(const std::string& name, const std::vector<std::pair<std::string, int>>& outcomes) {
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), MakePlan(study_));
    std::uint32_t trial = 0;
    for (const auto& [letters, count] : outcomes) {
      for (int i = 0; i < count; ++i) AddRecords(store, Trial(0, trial++, letters));
    }
  }
  Comparison CompareRun(const std::string& name, const std::string& reference = "",
                        const CompareOptions& options = {}) {
    return Compare(ResultStore::OpenForReading(folder_.Path(name)), reference, options);
  }
  static ComparisonRow Row(const Comparison& comparison, const std::string& event,
                           const std::string& estimator = "ours", std::uint32_t condition = 0) {
    for (const ComparisonRow& row : comparison.rows) {
      if (row.event == event && row.estimator == estimator && row.condition == condition) return row;
    }
    ADD_FAILURE() << "no row of " << event;
    return {};
  }
  static void ExpectCounts(const PairedCounts& counts, const PairedCounts& expected) {
    EXPECT_EQ(counts.both, expected.both);
    EXPECT_EQ(counts.first_only, expected.first_only);
    EXPECT_EQ(counts.second_only, expected.second_only);
    EXPECT_EQ(counts.neither, expected.neither);
  }

  TempFolder folder_;
  Study study_ = SmallStudy();  // estimators standard, ours; two conditions
};

// Of condition 0: 3 fail for the first alone, 1 for ours alone; of condition 1: 2 for the first alone.
TEST_F(CompareTest, PooledConditionsAreOne) {
  Write("run", {{"fs", 3}, {"sf", 1}, {"ss", 4}});
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_));
    for (std::uint32_t trial = 0; trial < 2; ++trial) AddRecords(store, Trial(1, trial, "fs"));
  }
  CompareOptions options;
  options.pooling = Pooling::kPooled;
  const Comparison pooled = CompareRun("run", "", options);
  EXPECT_TRUE(pooled.factor_names.empty());
  const ComparisonRow row = Row(pooled, "failure");
  ExpectCounts(row.counts, {.both = 0, .first_only = 1, .second_only = 5, .neither = 4});
  EXPECT_NEAR(row.p_value, 2.0 * (1.0 + 6.0) / 64.0, 1e-12);  // two-sided binomial of 1 in 6
  EXPECT_EQ(Row(CompareRun("run"), "failure", "ours", 1).counts.second_only, 2);
}

TEST_F(CompareTest, CountsByHand) {
  Write("run", {{"ss", 5}, {"sf", 1}, {"fs", 3}, {"ff", 2}, {"rs", 4}, {"sr", 1}, {"fr", 2}, {"rr", 1}});
  const Comparison comparison = CompareRun("run");
  EXPECT_EQ(comparison.reference, "standard");
  EXPECT_EQ(comparison.num_trials_done, 19);
  EXPECT_EQ(comparison.rows.size(), 2 * 3);  // two conditions, three events, one pair
  // both, ours only, standard only, neither
  ExpectCounts(Row(comparison, "failure").counts, {2, 1, 5, 11});
  ExpectCounts(Row(comparison, "refusal").counts, {1, 3, 4, 11});
  ExpectCounts(Row(comparison, "failure_or_refusal").counts, {5, 2, 7, 5});
  EXPECT_DOUBLE_EQ(Row(comparison, "failure").difference, -4.0 / 19.0);
}

TEST_F(CompareTest, ATrialThatOneMotionIsNotScoredInTellsNothingOfFailures) {
  Write("run", {{"ss", 5}, {"uf", 2}, {"su", 3}, {"uu", 1}, {"ru", 4}, {"fs", 1}, {"rs", 1}});
  const Comparison comparison = CompareRun("run");
  // both, ours only, standard only, neither
  ExpectCounts(Row(comparison, "failure").counts, {0, 0, 1, 6});
  ExpectCounts(Row(comparison, "refusal").counts, {0, 0, 5, 12});
  ExpectCounts(Row(comparison, "failure_or_refusal").counts, {0, 0, 2, 5});
}

TEST_F(CompareTest, PublishedIntervalAndPValue) {
  // Tango's interval and McNemar's p-value as in stats/paired_test.cc: (1, 1, 7, 12).
  Write("run", {{"ff", 1}, {"sf", 1}, {"fs", 7}, {"ss", 12}});
  const ComparisonRow row = Row(CompareRun("run"), "failure");
  EXPECT_NEAR(row.interval.lower, -0.517232276, 2e-9);
  EXPECT_NEAR(row.interval.upper, -0.026003034, 2e-9);
  EXPECT_NEAR(row.p_value, 0.0703125, 1e-12);
  EXPECT_DOUBLE_EQ(row.holm_p_value, 3 * row.p_value) << "three events: the other condition has no trial";
}

TEST_F(CompareTest, AnotherReferenceMirrorsTheComparison) {
  Write("run", {{"ff", 1}, {"sf", 1}, {"fs", 7}, {"ss", 12}});
  const Comparison comparison = CompareRun("run", "ours");
  const ComparisonRow row = Row(comparison, "failure", "standard");
  EXPECT_EQ(comparison.reference, "ours");
  ExpectCounts(row.counts, {1, 7, 1, 12});
  EXPECT_DOUBLE_EQ(row.difference, 6.0 / 21.0);
  EXPECT_NEAR(row.interval.lower, 0.026003034, 2e-9);
}

// Catches a family per event (2 p for two estimators), one per estimator (3 p), and conditions without trials
// that are counted as tests (12 p).
TEST_F(CompareTest, HolmGoesOverAllEventsEstimatorsAndConditions) {
  study_.estimators.push_back(study_.estimators[1]);
  study_.estimators[2].label = "third";
  // ours fails alone in 8 of 12: p = 2 / 2^8; third in 4: p = 2 / 2^4; nobody refuses: p = 1.
  Write("run", {{"sff", 4}, {"sfs", 4}, {"sss", 4}});
  const Comparison one = CompareRun("run");
  const double p8 = 2.0 / 256.0, p4 = 2.0 / 16.0;
  EXPECT_DOUBLE_EQ(Row(one, "failure", "ours").p_value, p8);
  EXPECT_DOUBLE_EQ(Row(one, "failure", "ours").holm_p_value, 6 * p8) << "two estimators, three events";
  EXPECT_DOUBLE_EQ(Row(one, "failure_or_refusal", "ours").holm_p_value, 6 * p8)
      << "the larger of 6 p and 5 p";
  EXPECT_DOUBLE_EQ(Row(one, "failure", "third").p_value, p4);
  EXPECT_DOUBLE_EQ(Row(one, "failure", "third").holm_p_value, 4 * p4);
  EXPECT_EQ(Row(one, "refusal", "third").holm_p_value, 1.0);
  // Four trials of the other condition, in which nothing happens: six more tests.
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_));
    for (std::uint32_t trial = 0; trial < 4; ++trial) AddRecords(store, Trial(1, trial, "sss"));
  }
  EXPECT_DOUBLE_EQ(Row(CompareRun("run"), "failure", "ours").holm_p_value, 12 * p8);
}

TEST_F(CompareTest, NoTrialsNoNumbers) {
  Write("run", {{"sf", 1}});
  const ComparisonRow row = Row(CompareRun("run"), "failure", "ours", 1);
  EXPECT_EQ(row.n, 0);
  EXPECT_TRUE(std::isnan(row.difference) && std::isnan(row.p_value) && std::isnan(row.holm_p_value));
  EXPECT_EQ(row.interval.lower, -1.0);
  EXPECT_EQ(row.interval.upper, 1.0);
}

TEST_F(CompareTest, RatesAreThoseOfTheSummary) {
  Write("run", {{"ss", 5}, {"sf", 1}, {"fs", 3}, {"ff", 2}, {"rs", 4}, {"sr", 1}});
  const Summary summary = Summarize(ResultStore::OpenForReading(folder_.Path("run")), false);
  const auto rate = [&](const std::string& estimator, const std::string& quantity) {
    for (const SummaryRow& row : summary.rows) {
      if (row.condition == 0 && row.estimator == estimator && row.quantity == quantity) return row.value;
    }
    return -1.0;
  };
  const Comparison comparison = CompareRun("run");
  const double failure = rate("ours", "failure") - rate("standard", "failure");
  const double refusal = rate("ours", "no_candidate") - rate("standard", "no_candidate");
  EXPECT_NEAR(Row(comparison, "failure").difference, failure, 1e-12);
  EXPECT_NEAR(Row(comparison, "refusal").difference, refusal, 1e-12);
  EXPECT_NEAR(Row(comparison, "failure_or_refusal").difference, failure + refusal, 1e-12);
}

TEST_F(CompareTest, OneEstimatorHasNothingToCompare) {
  study_.estimators.pop_back();
  Write("run", {{"s", 3}});
  EXPECT_TRUE(CompareRun("run").rows.empty());
  EXPECT_EQ(CompareRun("run").num_trials_done, 3);
}

TEST_F(CompareTest, ABadLabelNamesWhatIsAllowed) {
  Write("run", {{"ss", 1}});
  EXPECT_TRUE(ThrowsInputError([&] { CompareRun("run", "rcme"); },
                               {"--against", "'rcme'", "'small'", "allowed: standard, ours"}));
}

// Without columns that are the same in every row, or follow from others; differences in percentage points.
TEST_F(CompareTest, ATableForAPageHasWhatAReaderNeeds) {
  Write("run", {{"ff", 1}, {"sf", 1}, {"fs", 7}, {"ss", 12}});
  const CommandResult result = MakeComparisonResult(CompareRun("run"));
  const std::string page = RenderResult(result, "markdown");
  EXPECT_TRUE(
      page.starts_with("| outlier_ratio | estimator | compared | n | difference from standard (% points) | "
                       "Holm p |\n"))
      << page;
  EXPECT_NE(page.find("| 0 | ours | failure | 21 | -28.57 ["), std::string::npos) << page;
  EXPECT_NE(RenderResult(result, "latex").find("28.57"), std::string::npos);
}

TEST_F(CompareTest, CsvAndJsonHoldTheSameRows) {
  Write("run", {{"ff", 1}, {"sf", 1}, {"fs", 7}, {"ss", 12}});
  const Comparison comparison = CompareRun("run");
  std::istringstream csv(RenderCsv(MakeComparisonResult(comparison).rows));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_EQ(lines.size(), 7u);
  EXPECT_EQ(lines[0],
            "study,condition,outlier_ratio,estimator,reference,event,n,both,estimator_only,reference_only,"
            "neither,risk_difference,lower,upper,p_mcnemar,p_holm,kind,p_value,test,interval");
  EXPECT_EQ(lines[1], fmt::format("small,0,0,ours,standard,failure,21,1,1,7,12,-0.28571429,{:.8g},{:.8g},"
                                  "0.0703125,0.2109375,event,0.0703125,mcnemar,tango",
                                  comparison.rows[0].interval.lower, comparison.rows[0].interval.upper));
  EXPECT_EQ(lines[4], "small,1,0.3,ours,standard,failure,0,0,0,0,0,,-1,1,,,event,,mcnemar,tango");
  const nlohmann::json json = nlohmann::json::parse(MakeComparisonResult(comparison).json);
  EXPECT_EQ(json["reference"], "standard");
  ASSERT_EQ(json["rows"].size(), 6u);
  EXPECT_EQ(json["rows"][0]["levels"]["outlier_ratio"], "0");
  EXPECT_EQ(json["rows"][0]["estimator_only"], 1);
  EXPECT_EQ(json["rows"][0]["reference_only"], 7);
  EXPECT_EQ(json["rows"][0]["p_mcnemar"], comparison.rows[0].p_value);
  EXPECT_TRUE(json["rows"][3]["risk_difference"].is_null());
}

// Rotation errors (deg) of standard and ours in one trial; below zero: it refuses.
using Errors = std::pair<double, double>;

std::vector<TrialRecord> Trial(std::uint32_t trial, const Errors& errors_deg) {
  std::vector<TrialRecord> records = Trial(0, trial, "ss");
  for (auto& [record, error_deg] :
       {std::pair<TrialRecord&, double>{records[0], errors_deg.first}, {records[1], errors_deg.second}}) {
    if (error_deg < 0.0) record.status = MotionStatus::kNoCandidate;
    record.rotation_error_deg = error_deg < 0.0 ? std::numeric_limits<double>::quiet_NaN() : error_deg;
  }
  return records;
}

class CompareMeasuresTest : public CompareTest {
 protected:
  void Write(const std::string& name, const std::vector<Errors>& trials) {
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), MakePlan(study_));
    for (std::uint32_t trial = 0; trial < trials.size(); ++trial)
      AddRecords(store, Trial(trial, trials[trial]));
  }
};

TEST_F(CompareMeasuresTest, ScoresByHand) {
  // AUC@10 of standard: 0.9, 0.5, 0, 0.8 and a refusal; of ours: 1, 0.8, 0.2, a refusal, a refusal.
  Write("run", {{1.0, 0.0}, {5.0, 2.0}, {20.0, 8.0}, {2.0, -1.0}, {-1.0, -1.0}});
  const Comparison comparison = CompareRun("run", "", {.compared = {"scores"}});
  EXPECT_EQ(comparison.rows.size(), 2 * (TrialScores().size() + 1)) << "and Brier";
  const ComparisonRow row = Row(comparison, "auc_10_deg");
  ScoreMean expected({-1.0, 1.0});
  for (const double difference : {0.1, 0.3, 0.2, -0.8, 0.0}) expected.Add(difference);
  EXPECT_EQ(row.kind, ComparedKind::kScore);
  EXPECT_EQ(row.n, 5);
  EXPECT_NEAR(row.difference, -0.04, 1e-12);
  EXPECT_NEAR(row.p_value, expected.PValue(0.0), 1e-12);
  EXPECT_NEAR(row.interval.lower, expected.Sequence().lower, 1e-9);
  EXPECT_NEAR(row.interval.upper, expected.Sequence().upper, 1e-9);
  EXPECT_TRUE(row.is_anytime_valid);
  const ComparisonRow answered = Row(comparison, "auc_10_deg_answered");
  EXPECT_EQ(answered.n, 3) << "trials in which both answered";
  EXPECT_NEAR(answered.difference, 0.2, 1e-12);
  // The other way round it is the same with the sign changed.
  const ComparisonRow mirrored =
      Row(CompareRun("run", "ours", {.compared = {"scores"}}), "auc_10_deg", "standard");
  EXPECT_NEAR(mirrored.difference, 0.04, 1e-12);
  EXPECT_NEAR(mirrored.p_value, row.p_value, 1e-9);
  EXPECT_NEAR(mirrored.interval.lower, -row.interval.upper, 1e-9);
}

TEST_F(CompareMeasuresTest, ErrorsByHand) {
  // Ours minus standard: -1 (6 times), -3, +2, refused by ours alone: infinitely greater, and by both: equal.
  Write("run", {{2, 1}, {2, 1}, {2, 1}, {2, 1}, {2, 1}, {2, 1}, {5, 2}, {1, 3}, {1, -1}, {-1, -1}});
  const ComparisonRow row = Row(CompareRun("run", "", {.compared = {"errors"}}), "max_error_median_deg");
  ExpectCounts(row.counts, {0, 2, 7, 1});  // greater, less, equal
  EXPECT_EQ(row.n, 10);
  EXPECT_EQ(row.difference, -1.0);
  EXPECT_EQ(row.interval.lower, -1.0);  // the second and the ninth of ten
  EXPECT_EQ(row.interval.upper, 2.0);
  EXPECT_NEAR(row.p_value, 2.0 * (1 + 9 + 36) / 512.0, 1e-12) << "sign test: 2 of 9";
}

// A run that stopped by what it saw, or one of which somebody says so.
TEST_F(CompareMeasuresTest, WhatLooksAgainAndAgainGetsTestsThatAreValidAtEveryLook) {
  CompareTest::Write("run", {{"sf", 2}, {"fs", 12}, {"ss", 30}, {"ff", 6}});
  const CompareOptions all{.compared = {"failure", "max_error_median_deg"}};
  CompareOptions asked_for = all;
  asked_for.is_anytime_valid = true;
  const ComparisonRow once = Row(CompareRun("run", "", all), "failure");
  EXPECT_EQ(once.p_value, McNemarExactPValue(once.counts));
  EXPECT_FALSE(once.is_anytime_valid);
  const Comparison by_hand = CompareRun("run", "", asked_for);
  ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_)).NoteStoppingRule("a reason");
  const Comparison stopped = CompareRun("run", "", all);
  EXPECT_TRUE(stopped.caution.empty());
  ScoreMean difference({-1.0, 1.0});  // the concordant trials count as zero
  difference.Add(1.0, 2);
  difference.Add(-1.0, 12);
  difference.Add(0.0, 36);
  for (const Comparison& comparison : {by_hand, stopped}) {
    const ComparisonRow failure = Row(comparison, "failure"), error = Row(comparison, "max_error_median_deg");
    EXPECT_TRUE(failure.is_anytime_valid && error.is_anytime_valid);
    ExpectCounts(failure.counts, once.counts);
    EXPECT_EQ(failure.p_value, AnytimeMcNemarPValue(once.counts));
    EXPECT_GT(failure.p_value, once.p_value);
    EXPECT_LT(failure.interval.lower, once.interval.lower);
    EXPECT_GT(failure.interval.upper, once.interval.upper);
    EXPECT_EQ(failure.interval.lower, difference.Sequence().lower);
    EXPECT_EQ(failure.interval.upper, difference.Sequence().upper);
    EXPECT_EQ(failure.holm_p_value, std::min(1.0, 2.0 * failure.p_value));
    EXPECT_EQ(error.p_value, AnytimeMcNemarPValue(error.counts));
    EXPECT_TRUE(std::isnan(error.interval.lower) && std::isnan(error.interval.upper));
  }
  const std::string csv = RenderCsv(MakeComparisonResult(stopped).rows);
  EXPECT_NE(csv.find(",event,0.0"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",discordant_sequence,betting\n"), std::string::npos) << csv;
  EXPECT_NE(csv.find(",discordant_sequence,\n"), std::string::npos) << csv;
  EXPECT_TRUE(nlohmann::json::parse(MakeComparisonResult(stopped).json)["rows"][0]["p_mcnemar"].is_null());
  const std::string table = MakeComparisonResult(stopped).text;
  EXPECT_NE(table.find("valid at every look"), std::string::npos) << table;
  EXPECT_EQ(table.find("McNemar"), std::string::npos) << table;
}

TEST_F(CompareMeasuresTest, OnlyWhatIsAskedForIsComparedAndCostsTheOthersAnything) {
  Write("run", {{1.0, 0.0}, {5.0, 2.0}, {20.0, 8.0}});
  const auto names_of = [&](const std::vector<std::string>& compared) {
    std::vector<std::string> names;
    for (const Compared& each : CompareRun("run", "", {.compared = compared}).compared)
      names.push_back(each.name);
    return names;
  };
  EXPECT_EQ(names_of({"events"}), (std::vector<std::string>{"failure", "refusal", "failure_or_refusal"}));
  EXPECT_EQ(names_of({"auc_5_deg", "failure", "auc_5_deg"}),
            (std::vector<std::string>{"failure", "auc_5_deg"}));
  EXPECT_EQ(names_of({"events", "scores", "errors"}).size(), AllCompared().size());
  const Comparison two = CompareRun("run", "", {.compared = {"auc_5_deg", "max_error_median_deg"}});
  EXPECT_DOUBLE_EQ(Row(two, "max_error_median_deg").p_value, 0.25);
  EXPECT_DOUBLE_EQ(Row(two, "max_error_median_deg").holm_p_value, 0.5);
  EXPECT_TRUE(
      ThrowsInputError([&] { names_of({"auc"}); }, {"--of", "'auc'", "allowed: events, scores, errors"}));
  EXPECT_TRUE(ThrowsInputError([&] { names_of({}); }, {"--of", "nothing is named"}));
}

// Two scenes of two trials, and one cut off: the repeats of a scene are one number.
TEST_F(CompareMeasuresTest, RepeatedScenesAreComparedByTheirMeans) {
  study_.repeats_per_scene = 2;
  // Failures (beyond 3 deg) of standard and ours, trial by trial: 10, 00 | 11, 10 | 00.
  Write("run", {{10.0, 1.0}, {1.0, 1.0}, {10.0, 10.0}, {10.0, 2.0}, {1.0, 1.0}});
  const Comparison comparison =
      CompareRun("run", "", {.compared = {"failure", "auc_20_deg", "max_error_median_deg"}});
  ScoreMean failure({-1.0, 1.0}), area({-1.0, 1.0});
  failure.Add(-0.5, 2), failure.Add(0.0);
  area.Add((0.45 + 0.0) / 2.0), area.Add((0.0 + 0.4) / 2.0), area.Add(0.0);
  const ComparisonRow row = Row(comparison, "failure");
  ExpectCounts(row.counts, {1, 0, 2, 2});
  EXPECT_EQ(row.n, 3);
  EXPECT_TRUE(row.is_of_scenes);
  EXPECT_NEAR(row.difference, -1.0 / 3.0, 1e-12);
  EXPECT_NEAR(row.p_value, failure.PValue(0.0), 1e-12);
  EXPECT_NEAR(row.interval.lower, failure.Sequence().lower, 1e-12);
  EXPECT_NEAR(Row(comparison, "auc_20_deg").difference, area.mean(), 1e-12);
  EXPECT_NEAR(Row(comparison, "auc_20_deg").p_value, area.PValue(0.0), 1e-12);
  const ComparisonRow error = Row(comparison, "max_error_median_deg");
  EXPECT_EQ(error.n, 3) << "first trials";
  ExpectCounts(error.counts, {0, 0, 1, 2});
  EXPECT_NE(RenderCsv(MakeComparisonResult(comparison).rows).find(",betting,betting\n"), std::string::npos);
  EXPECT_NE(MakeComparisonResult(comparison).text.find("Scenes are repeated"), std::string::npos);
}

TEST_F(CompareTest, TableSaysWhatItsNumbersAre) {
  Write("run", {{"ff", 1}, {"sf", 1}, {"fs", 7}, {"ss", 12}});
  const std::string table = MakeComparisonResult(CompareRun("run")).text;
  EXPECT_TRUE(std::regex_search(table, std::regex("ours +21 +1 +1 +7 +12\\n")))
      << table;  // n, both, ours only
  for (const char* part : {"Study small against standard: 21 of 12 trials done", "standard only",
                           "-28.57 [-51.72, -2.60]", "0.0703", "Tango", "McNemar", "all 3 tests"}) {
    EXPECT_NE(table.find(part), std::string::npos) << part << " is not in\n" << table;
  }
}

// In place of tables of zeros; an event that happened once has its table, and files have all rows.
TEST_F(CompareTest, EventsThatHappenedNeverHaveOneLineTogether) {
  Write("run", {{"ss", 12}});
  const CommandResult never = MakeComparisonResult(CompareRun("run"));
  EXPECT_EQ(
      never.text,
      "Study small against standard: 12 of 12 trials done\n"
      "\nfailure, refusal, failure_or_refusal: in no trial of any estimator; --of errors compares their "
      "errors.\n");
  EXPECT_EQ(never.rows.rows.size(), 2 * 3);
  CompareOptions options;
  options.compared = {"events", "max_error_median_deg"};
  const std::string with_errors = MakeComparisonResult(CompareRun("run", "", options)).text;
  EXPECT_NE(with_errors.find("failure_or_refusal: in no trial of any estimator.\n"), std::string::npos)
      << with_errors;
  EXPECT_NE(with_errors.find("median difference"), std::string::npos) << with_errors;
  EXPECT_EQ(with_errors.find("Events:"), std::string::npos) << with_errors;

  Write("one", {{"ss", 11}, {"sf", 1}});
  const std::string once = MakeComparisonResult(CompareRun("one")).text;
  EXPECT_NE(once.find("\nrefusal: in no trial of any estimator.\n"), std::string::npos) << once;
  EXPECT_TRUE(std::regex_search(once, std::regex("ours +12 +0 +1 +0 +11\\n"))) << once;
  EXPECT_NE(once.find("Events:"), std::string::npos) << once;
}

TEST_F(CompareTest, TableSaysThatATargetIsNotReached) {
  Write("run", {{"fs", 1}, {"ss", 11}});
  const auto text = [&] { return MakeComparisonResult(CompareRun("run")).text; };
  ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_)).NoteStoppingRule(kUntilRule);
  EXPECT_NE(text().find("against standard: 12 trials done\nThe target of `rcme run --until` is not reached"),
            std::string::npos)
      << text();
  ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_)).NoteUntilOptions("--until ci=0.1", 12);
  EXPECT_NE(text().find("12 of 12 trials done\n"), std::string::npos) << text();
}

}  // namespace
}  // namespace rcme
