#include "experiments/statistics/summarize.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "experiments/statistics/compare.h"
#include "experiments/statistics/quantity_table.h"
#include "experiments/statistics/summary_output.h"
#include "parameters/input_error.h"
#include "stats/confidence_sequence.h"
#include "stats/score_mean.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

class SummarizeTest : public SummarizedRun {};

TEST_F(SummarizeTest, RatesByHand) {
  ExpectRate("success", 4, 10);
  ExpectRate("failure", 2, 10);
  ExpectRate("failure_or_refusal", 6, 10);
  ExpectRate("no_candidate", 2, 10);
  ExpectRate("too_few_matches", 1, 10);
  ExpectRate("degenerate_matches", 0, 10);
  ExpectRate("refinement_diverged", 1, 10);
  ExpectRate("invalid_input", 0, 10);
  ExpectRate("other_refusal", 2, 10);  // too_few_matches and refinement_diverged
  ExpectRate("kappa_flag", 1, 6);      // of the six returned motions
  ExpectRate("nees_coverage", 4, 6);   // 4, 6, 2, 3 of 4, 6, 20, 2, 30, 3
}

TEST_F(SummarizeTest, AKnownInterval) {
  // Clopper-Pearson of 4 of 10, e.g. R: binom.test(4, 10)$conf.int.
  EXPECT_NEAR(Row("success").interval.lower, 0.1215523, 1e-7);
  EXPECT_NEAR(Row("success").interval.upper, 0.7376219, 1e-7);
}

// Where the first condition has no trial its rows have n = 0, and the second has its own.
TEST_F(SummarizeTest, AConditionWithoutTrialsKeepsItsRows) {
  std::vector<TrialRecord> records = HandMadeRecords();
  for (TrialRecord& record : records) record.condition = 1;
  Write("second", records);
  const Summary summary = SummarizeRun("second"), first = SummarizeRun("run");
  ASSERT_EQ(summary.rows.size(), first.rows.size());
  const size_t half = summary.rows.size() / 2;
  for (size_t i = 0; i < half; ++i) {
    EXPECT_EQ(summary.rows[i].condition, 0u);
    EXPECT_EQ(summary.rows[i].n, 0);
    EXPECT_EQ(summary.rows[half + i].condition, 1u);
    EXPECT_EQ(summary.rows[half + i].quantity, first.rows[i].quantity);
    EXPECT_EQ(summary.rows[half + i].n, first.rows[i].n);
  }
}

// The ten trials in one condition, and six of them in another.
TEST_F(SummarizeTest, PooledConditionsAreOne) {
  std::vector<TrialRecord> records = HandMadeRecords();
  for (size_t i = 0; i < 6; ++i) {
    records.push_back(records[i]);
    records.back().condition = 1;
  }
  Write("both", records);
  const Summary pooled = Summarize(ResultStore::OpenForReading(folder_.Path("both")), true, Pooling::kPooled);
  EXPECT_TRUE(pooled.factor_names.empty());
  EXPECT_EQ(pooled.levels, std::vector<std::vector<std::string>>(1));
  int num_checked = 0;
  for (const SummaryRow& row : pooled.rows) {
    EXPECT_EQ(row.condition, 0u);
    if (row.quantity != "success") continue;
    ++num_checked;
    EXPECT_EQ(row.n, 16);
    EXPECT_DOUBLE_EQ(row.value, 8.0 / 16.0);
  }
  EXPECT_EQ(num_checked, 1);
}

TEST_F(SummarizeTest, MeansByHand) {
  ExpectMean("nees", {4, 6, 20, 2});
  ExpectMean("rotation_error_deg", {1, 2, 3, 2});
  ExpectMean("direction_error_deg", {2, 4, 15, 3});
  ExpectMean("inlier_precision", {0.5, 0.5, 0.5, 1.0, 0.5, 0.5});
  ExpectMean("inlier_recall", {0.25, 0.25, 0.25, 0.25, 0.25, 0.25});
  ExpectMean("num_support", {10, 11, 12, 13, 14, 15});
  ExpectMean("explained_share", {0.5, 0.5, 0.5, 0.5, 0.5, 0.5});
  ExpectMean("mean_entropy", {-4, -4, -4, -4, -4, -4});
  ExpectMean("num_candidates", {3, 3, 3, 3, 3, 3, 0, 0, 0, 0});
}

// Coverage has sharpness and scores of the stated density beside it, of every returned motion.
TEST_F(SummarizeTest, ScoresOfTheStatedDensityByHand) {
  ExpectMean("energy_score_deg", {0.5, 1.0, 1.5, 1.0, 1.75, 0.5});
  ExpectMean("log_score", {-16.0, -14.0, 0.0, -18.0, 10.0, -17.0});
  ExpectMean("log_det_cov", {-50.0, -50.0, -50.0, -50.0, -50.0, -50.0});
  ExpectRate("singular_covariance", 0, 6);
  ExpectRate("available", 3, 10);  // rotation levels of 1, 2, 3 deg; the next is beyond the bound of 3
  ExpectRate("misleading", 4, 6);  // directions beyond levels of 0, 2, 4 and 10 deg
  EXPECT_EQ(Row("sd_over_crb").value, 3.0);  // of 1 .. 6 the lower middle
  EXPECT_EQ(Row("rotation_sd_deg").value, 2.5);
  EXPECT_EQ(Row("direction_sd_deg").value, 5.0);
}

// By numpy: the mean of cumsum(e[order]) / (1, ..., 6) for the order of the stated sd and for that of the
// errors, 1, 2, 3, 2, 3.5, 1 and 2, 4, 15, 3, 1, 40 deg, the stated sd rising. Failures are among them,
// refusals not.
TEST_F(SummarizeTest, RankingsOfErrorsByHand) {
  const struct {
    const char* quantity;
    double value;
  } kExpected[] = {{"rotation_ause", 0.17333333333333},
                   {"rotation_ause_random", 0.30266666666667},
                   {"direction_ause", 0.16923076923077},
                   {"direction_ause_random", 0.64871794871795}};
  for (const auto& [quantity, value] : kExpected) {
    const SummaryRow row = Row(quantity);
    EXPECT_EQ(row.kind, SummaryRow::Kind::kArea) << quantity;
    EXPECT_NEAR(row.value, value, 1e-12) << quantity;
    EXPECT_EQ(row.n, 6) << quantity;
    EXPECT_GT(row.standard_error, 0.0) << quantity;
    EXPECT_TRUE(row.interval.Contains(value)) << quantity;
    EXPECT_EQ(Row(quantity, 1).n, 0) << quantity;  // without a trial
  }
  EXPECT_NE(SummaryAsTable(SummarizeRun("run")).find("rotation_ause_random"), std::string::npos);
  EXPECT_NE(SummaryAsCsv(SummarizeRun("run")).find("direction_ause,area,0.16923077,"), std::string::npos);
}

// An answer without a covariance ranks nothing; of none there is no row.
TEST_F(SummarizeTest, WhatStatesNothingIsNotRanked) {
  std::vector<TrialRecord> records = HandMadeRecords();
  records[5].density = {};
  records[4].direction_error_deg = kNaN;  // its truth is not known
  Write("some", records);
  for (const SummaryRow& row : SummarizeRun("some").rows) {
    if (row.condition != 0) continue;
    if (row.quantity == "rotation_ause") {
      EXPECT_EQ(row.n, 5);
    } else if (row.quantity == "direction_ause") {
      EXPECT_EQ(row.n, 4);
    }
  }
  for (TrialRecord& record : records) record.density = {};
  Write("none", records);
  const Summary none = SummarizeRun("none");
  EXPECT_EQ(std::ranges::count(none.rows, "rotation_ause", &SummaryRow::quantity), 0);
  EXPECT_EQ(SummaryAsTable(none).find("ause"), std::string::npos);
}

// It has no logarithmic score, and is counted instead.
TEST_F(SummarizeTest, ASingularCovarianceIsNamed) {
  std::vector<TrialRecord> records = HandMadeRecords();
  records[1].density.kind = static_cast<int>(StatedDensity::Kind::kSingular);
  records[1].density.log_det_cov = records[1].density.log_score = kNaN;
  Write("singular", records);
  std::map<std::string, SummaryRow> rows;
  for (const SummaryRow& row : SummarizeRun("singular").rows)
    if (row.condition == 0 && row.estimator == "standard") rows[row.quantity] = row;
  EXPECT_EQ(rows.at("singular_covariance").value, 1.0 / 6.0);
  EXPECT_EQ(rows.at("log_score").n, 5);
  EXPECT_EQ(rows.at("energy_score_deg").n, 6);
}

// The text shows sharpness beside coverage: in degrees where no bound is known.
TEST_F(SummarizeTest, CoverageIsNotShownWithoutSharpness) {
  std::string text = SummaryAsTable(SummarizeRun("run"));
  text.resize(text.find("Rates: intervals"));  // without the legend
  for (const char* column :
       {"nees_coverage", "sd_over_crb", "energy_score_deg", "log_score", "available", "misleading"})
    EXPECT_NE(text.find(column), std::string::npos) << column;
  std::vector<TrialRecord> records = HandMadeRecords();
  for (TrialRecord& record : records) record.density.sd_over_crb = kNaN;
  Write("unbounded", records);
  const Summary unbounded = SummarizeRun("unbounded");
  EXPECT_EQ(std::ranges::count(unbounded.rows, "sd_over_crb", &SummaryRow::quantity), 0);
  EXPECT_NE(SummaryAsTable(unbounded).find("rotation_sd_deg  "), std::string::npos);
}

// Whatever the format, and whatever was asked for.
TEST_F(SummarizeTest, SharpnessIsAddedToCoverage) {
  using Names = std::vector<std::string>;
  const Summary summary = SummarizeRun("run");
  EXPECT_EQ(AddSharpness(summary, {"failure", "nees_coverage", "auc_10_deg"}),
            (Names{"failure", "nees_coverage", "sd_over_crb", "auc_10_deg"}));
  EXPECT_EQ(AddSharpness(summary, {"nees_coverage", "rotation_sd_deg"}),
            (Names{"nees_coverage", "rotation_sd_deg"}));
  EXPECT_EQ(AddSharpness(summary, {"failure"}), (Names{"failure"}));
  std::vector<TrialRecord> records = HandMadeRecords();
  for (TrialRecord& record : records) record.density.sd_over_crb = kNaN;
  Write("unbounded", records);
  EXPECT_EQ(AddSharpness(SummarizeRun("unbounded"), {"nees_coverage"}),
            (Names{"nees_coverage", "rotation_sd_deg", "direction_sd_deg"}));
  for (TrialRecord& record : records) record.density = {};
  Write("none", records);
  EXPECT_EQ(AddSharpness(SummarizeRun("none"), {"nees_coverage"}), (Names{"nees_coverage"}));
}

// Every returned motion counts, failures too: their NEES are 4, 6, 20, 2, 30, 3.
TEST_F(SummarizeTest, MediansByHand) {
  const SummaryRow nees = Row("nees_median"), time = Row("time_ms");
  EXPECT_EQ(nees.kind, SummaryRow::Kind::kMedian);
  EXPECT_EQ(nees.n, 6);
  EXPECT_EQ(nees.value, 4.0);
  EXPECT_EQ(nees.interval.lower, 2.0);  // the least and the greatest: 1 - 2 / 2^6 = 0.969
  EXPECT_EQ(nees.interval.upper, 30.0);
  EXPECT_EQ(time.n, 10);
  EXPECT_EQ(time.value, 2.0);
  EXPECT_EQ(time.interval.lower, 2.0);  // the second and the ninth of ten: 0.979
  EXPECT_EQ(time.interval.upper, 4.0);
}

// Of ten trials: errors (the greater one) 2, 4, 15, 3, 3.5 and 40 deg, and four refusals.
TEST_F(SummarizeTest, ScoresByHand) {
  const auto expect = [&](const std::string& quantity, const std::vector<double>& scores) {
    double sum = 0.0;
    ScoreMean mean;
    for (const double score : scores) sum += score, mean.Add(score);
    const SummaryRow row = Row(quantity);
    EXPECT_EQ(row.kind, SummaryRow::Kind::kScore) << quantity;
    EXPECT_EQ(row.n, static_cast<std::int64_t>(scores.size())) << quantity;
    EXPECT_NEAR(row.value, sum / static_cast<double>(scores.size()), 1e-12) << quantity;
    EXPECT_EQ(row.interval.lower, mean.Sequence().lower) << quantity;
    EXPECT_EQ(row.interval.upper, mean.Sequence().upper) << quantity;
    EXPECT_EQ(row.interval_kind, IntervalKind::kBetting) << quantity;
  };
  expect("auc_5_deg", {0.6, 0.2, 0.0, 0.4, 0.3, 0.0, 0.0, 0.0, 0.0, 0.0});
  expect("auc_5_deg_answered", {0.6, 0.2, 0.0, 0.4, 0.3, 0.0});
  expect("auc_10_deg_answered", {0.8, 0.6, 0.0, 0.7, 0.65, 0.0});
  expect("auc_20_deg", {0.9, 0.8, 0.25, 0.85, 0.825, 0.0, 0.0, 0.0, 0.0, 0.0});
  expect("maa_10_deg", {0.9, 0.7, 0.0, 0.8, 0.7, 0.0, 0.0, 0.0, 0.0, 0.0});
}

TEST_F(SummarizeTest, MedianErrorsByHand) {
  const double infinity = std::numeric_limits<double>::infinity();
  // Rotation errors 1, 2, 3, 2, 3.5, 1, four times infinity: the fifth of ten, from the second to the ninth.
  EXPECT_EQ(Row("rotation_error_median_deg").value, 3.0);
  EXPECT_EQ(Row("rotation_error_median_deg").n, 10);
  EXPECT_EQ(Row("rotation_error_median_deg").interval.lower, 1.0);
  EXPECT_EQ(Row("rotation_error_median_deg").interval.upper, infinity);
  EXPECT_EQ(Row("rotation_error_median_deg_answered").value, 2.0);
  EXPECT_EQ(Row("rotation_error_median_deg_answered").n, 6);
  EXPECT_EQ(Row("direction_error_median_deg_answered").value, 3.0);  // 2, 4, 15, 3, 1, 40
  EXPECT_EQ(Row("max_error_median_deg_answered").value, 3.5);        // 2, 4, 15, 3, 3.5, 40
  EXPECT_EQ(Row("max_error_median_deg").value, 15.0);
}

// What was there before stands before what was added: files of old and new programs can be compared line by
// line.
TEST_F(SummarizeTest, ScoresAndMedianErrorsComeLast) {
  const std::vector<SummaryRow> rows = SummarizeRun("run", true).rows;
  const auto time = std::ranges::find(rows, "time_ms", &SummaryRow::quantity);
  ASSERT_NE(time, rows.end());
  EXPECT_EQ((time + 1)->quantity, "mean_time_ms");
  EXPECT_EQ((time + 2)->quantity, "auc_5_deg");
  EXPECT_EQ((time + 9)->quantity, "maa_10_deg_answered");
  EXPECT_EQ((time + 15)->quantity, "max_error_median_deg_answered");
  EXPECT_EQ((time + 16)->quantity, "rotation_ause");
  EXPECT_EQ((time + 20)->estimator, kSceneLabel);
}

// A covariance that is not positive definite has an infinite NEES, which a median survives and a mean does
// not.
TEST_F(SummarizeTest, AnInfiniteNeesCountsInTheMedian) {
  std::vector<TrialRecord> records;
  for (std::uint32_t t = 0; t < 9; ++t) {
    records.push_back(Motion(t, 1.0, 1.0, t < 3 ? std::numeric_limits<double>::infinity() : 1.0 * t));
    records.back().condition = 1;
  }
  Write("run", records);
  EXPECT_EQ(Row("nees_median", 1).n, 9);
  EXPECT_EQ(Row("nees_median", 1).value, 7.0);  // of 3 .. 8 and three infinite ones
  EXPECT_NE(SummaryAsCsv(SummarizeRun("run")).find(",nees_median,median,7,4,,,9,,,\n"), std::string::npos)
      << "an infinite end is empty";
}

// So many motions of which so many are within the region.
std::vector<TrialRecord> Covered(int num_covered, int n) {
  std::vector<TrialRecord> records;
  for (int t = 0; t < n; ++t) {
    // On either side of the 95 % quantile of chi2_5, 11.0705.
    records.push_back(Motion(static_cast<std::uint32_t>(t), 1.0, 1.0, t < num_covered ? 11.07 : 11.071));
    records.back().condition = 1;
  }
  return records;
}

// Exact 95 % intervals against 0.95 +- 0.01. Catches a verdict by the point alone, or by "contains 0.95".
TEST_F(SummarizeTest, CoverageHasAVerdictAndWhatWouldDecide) {
  const auto verdict_of = [&](const std::string& name, int num_covered, int n) {
    Write(name, Covered(num_covered, n));
    for (const SummaryRow& row : SummarizeRun(name).rows) {
      if (row.condition == 1 && row.quantity == "nees_coverage") return row.coverage_verdict.value();
    }
    return CoverageVerdict();
  };
  EXPECT_EQ(verdict_of("covers", 4760, 5000).verdict, RegionVerdict::kCovers);     // [.9457, .9577]
  EXPECT_EQ(verdict_of("undecided", 95, 100).verdict, RegionVerdict::kUndecided);  // [.887, .984]
  EXPECT_EQ(verdict_of("near", 4700, 5000).verdict, RegionVerdict::kUndecided);    // .940 [.933, .946]
  EXPECT_EQ(verdict_of("too few", 180, 200).verdict, RegionVerdict::kTooNarrow);   // [.850, .938]
  EXPECT_EQ(verdict_of("too many", 1990, 2000).verdict, RegionVerdict::kTooWide);  // [.991, .998]
  EXPECT_NEAR(verdict_of("undecided", 0, 0).trials_to_decide, TrialsToDecide(0.95, {0.94, 0.96}), 1e-9);
  EXPECT_NE(SummaryAsTable(SummarizeRun("covers")).find(": covers"), std::string::npos);
  EXPECT_NE(SummaryAsTable(SummarizeRun("too few")).find(": too narrow"), std::string::npos);
  EXPECT_NE(SummaryAsTable(SummarizeRun("too many")).find(": too wide"), std::string::npos);
  EXPECT_NE(SummaryAsTable(SummarizeRun("undecided")).find(": undecided, about 6200"), std::string::npos)
      << SummaryAsTable(SummarizeRun("undecided"));
  EXPECT_NE(SummaryAsCsv(SummarizeRun("too few")).find(",200,exact,too narrow,\n"), std::string::npos);
  EXPECT_FALSE(Row("success").coverage_verdict) << "a rate that nothing is claimed of";
  EXPECT_FALSE(Row("nees_coverage", 1).coverage_verdict) << "no trials";
}

// Half of the trials return a motion: twice as many trials are needed as motions.
TEST_F(SummarizeTest, TrialsThatDecideCountRefusalsToo) {
  std::vector<TrialRecord> records = Covered(95, 100);
  for (std::uint32_t t = 100; t < 200; ++t) {
    records.push_back(NoMotion(t, MotionStatus::kNoCandidate));
    records.back().condition = 1;
  }
  Write("run", records);
  EXPECT_NEAR(Row("nees_coverage", 1).coverage_verdict.value().trials_to_decide,
              2.0 * TrialsToDecide(0.95, {0.94, 0.96}), 1e-9);
}

bool IsOfOutside(MotionStatus status) {
  return status == MotionStatus::kTimedOut || status == MotionStatus::kNoAnswer ||
         status == MotionStatus::kUnreadableAnswer;
}

TEST_F(SummarizeTest, EveryTrialHasExactlyOneOutcome) {
  double sum = 0.0;
  std::set<std::string> outcomes = {"success", "failure"};
  for (const MotionStatus status : AllStatuses()) {
    TrialRecord record;
    record.status = status;
    if (HasRefused(record) && !IsOfOutside(status)) outcomes.insert(StatusName(status));
  }
  for (const std::string& outcome : outcomes) sum += Row(outcome).value;
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST_F(SummarizeTest, StatusesOfOutsideEstimatorsHaveRowsOnlyWhereTheyHappened) {
  const auto count = [](const Summary& summary) {
    return std::ranges::count_if(summary.rows, [](const SummaryRow& row) {
      return row.quantity == "timed_out" || row.quantity == "no_answer" ||
             row.quantity == "unreadable_answer";
    });
  };
  std::vector<TrialRecord> records = HandMadeRecords();
  Write("none", records);
  EXPECT_EQ(count(SummarizeRun("none")), 0);
  records[0].status = MotionStatus::kTimedOut;
  Write("one", records);
  EXPECT_GT(count(SummarizeRun("one")), 0);
}

// Of three answers with P: .05 (right), .02 (fails), .5 (fails); refusals and answers without one are in
// none.
TEST_F(SummarizeTest, ProbabilitiesOfFailure) {
  std::vector<TrialRecord> records = HandMadeRecords();
  for (TrialRecord& record : records) record.failure_probability = HasRefused(record) ? 0.9 : kNaN;
  records[0].failure_probability = 0.05;
  records[4].failure_probability = 0.02;
  records[5].failure_probability = 0.5;
  Write("stated", records);
  std::map<std::string, SummaryRow> rows;
  for (const SummaryRow& row : SummarizeRun("stated").rows) {
    if (row.condition == 0) rows.try_emplace(row.quantity, row);
  }
  EXPECT_EQ(rows["failure_probability"].n, 3);
  EXPECT_NEAR(rows["failure_probability"].value, 0.19, 1e-12);
  EXPECT_EQ(rows["brier"].kind, SummaryRow::Kind::kScore);
  EXPECT_NEAR(rows["brier"].value, (0.0025 + 0.98 * 0.98 + 0.25) / 3.0, 1e-12);
  EXPECT_EQ(rows["failure_of_sure"].n, 2);
  EXPECT_EQ(rows["failure_of_sure"].value, 0.5);
  EXPECT_EQ(rows["failure_of_sure"].interval.upper, ExactBinomialInterval(1, 2).upper);
}

TEST_F(SummarizeTest, WithoutProbabilitiesThereAreNoRowsOfThem) {
  std::vector<TrialRecord> records = HandMadeRecords();
  for (TrialRecord& record : records)
    record.failure_probability = record.inlier_brier = record.sigma_estimated_px = kNaN;
  Write("unstated", records);
  for (const SummaryRow& row : SummarizeRun("unstated").rows) {
    for (const char* quantity :
         {"failure_probability", "brier", "failure_of_sure", "inlier_brier", "sigma_estimated_px"})
      EXPECT_NE(row.quantity, quantity);
  }
}

TEST_F(SummarizeTest, EmptyCellsSayThatNothingIsKnown) {
  for (const char* quantity : {"success", "nees_coverage"}) {
    const SummaryRow row = Row(quantity, 1);
    EXPECT_EQ(row.n, 0);
    EXPECT_TRUE(std::isnan(row.value));
    EXPECT_EQ(row.interval.lower, 0.0);
    EXPECT_EQ(row.interval.upper, 1.0);
  }
  EXPECT_TRUE(std::isnan(Row("nees", 1).value));
  EXPECT_TRUE(std::isnan(Row("nees", 1).standard_error));
}

TEST_F(SummarizeTest, RowsAreComplete) {
  const Summary summary = SummarizeRun("run", true);
  EXPECT_EQ(summary.study, "small");
  EXPECT_EQ(summary.factor_names, std::vector<std::string>{"outlier_ratio"});
  EXPECT_EQ(summary.num_trials_done, 10);
  EXPECT_EQ(summary.num_trials_planned, 12);
  const auto is_left_out = [](const QuantityHelp& q) {
    return q.base == "repeated scenes" || q.name == "timed_out" || q.name == "no_answer" ||
           q.name == "unreadable_answer" || q.name == "not_simulated";
  };
  EXPECT_EQ(summary.rows.size(),
            2 * SummaryQuantities().size() -
                2 * static_cast<size_t>(std::ranges::count_if(SummaryQuantities(), is_left_out)));
  EXPECT_EQ(summary.levels, (std::vector<std::vector<std::string>>{{"0"}, {"0.3"}}));
  for (const SummaryRow& row : SummarizeRun("run").rows)
    EXPECT_EQ(row.quantity.text().find("time_ms"), std::string::npos) << "times were not asked for";
}

TEST_F(SummarizeTest, UnknownTruthIsNotCounted) {
  TrialRecord unknown = Motion(0, kNaN, kNaN, kNaN);
  unknown.condition = 1;
  TrialRecord no_direction = Motion(1, 1.0, kNaN, kNaN);
  no_direction.condition = 1;
  Write("run", {unknown, no_direction});
  EXPECT_EQ(Row("rotation_error_deg", 1).n, 1);
  EXPECT_EQ(Row("direction_error_deg", 1).n, 0);
  EXPECT_EQ(Row("nees_coverage", 1).n, 0);
  EXPECT_EQ(Row("num_support", 1).n, 2);
}

// What is not known is neither a success nor "no failure".
TEST_F(SummarizeTest, AMotionWithoutAKnownTruthNeitherFailsNorSucceeds) {
  std::vector<TrialRecord> records = {Motion(0, kNaN, kNaN, kNaN), Motion(1, kNaN, kNaN, kNaN),
                                      Motion(2, 9.0, 1.0, 30.0), NoMotion(3, MotionStatus::kNoCandidate)};
  for (TrialRecord& record : records) record.condition = 1;
  Write("run", records);
  EXPECT_EQ(Row("not_scored", 1).value, 0.5);
  EXPECT_EQ(Row("not_scored", 1).n, 4);
  EXPECT_EQ(Row("failure", 1).value, 0.5);
  EXPECT_EQ(Row("failure", 1).n, 2);
  EXPECT_EQ(Row("success", 1).n, 2);
  EXPECT_EQ(Row("no_candidate", 1).n, 4);
}

// An answer that is not valid is a failure with or without a truth, and covers nothing: none leaves an n.
TEST_F(SummarizeTest, InvalidAnswersAreFailuresInEveryCount) {
  TrialRecord no_motion = NoMotion(0, MotionStatus::kInvalidMotion);
  no_motion.nees = std::numeric_limits<double>::infinity();
  TrialRecord no_covariance = Motion(1, 0.5, 0.5, std::numeric_limits<double>::infinity());
  no_covariance.status = MotionStatus::kInvalidCovariance;
  std::vector<TrialRecord> records = {no_motion, no_covariance, Motion(2, 0.5, 0.5, 4.0),
                                      NoMotion(3, MotionStatus::kInvalidMotion)};  // no truth
  for (TrialRecord& record : records) record.condition = 1;
  Write("run", records);
  const auto expect = [&](const std::string& quantity, double value, std::int64_t n) {
    EXPECT_EQ(Row(quantity, 1).n, n) << quantity;
    EXPECT_DOUBLE_EQ(Row(quantity, 1).value, value) << quantity;
  };
  expect("failure", 0.75, 4);
  expect("success", 0.25, 4);
  expect("invalid_motion", 0.5, 4);
  expect("invalid_covariance", 0.25, 4);
  expect("other_refusal", 0.0, 4);
  expect("not_scored", 0.0, 4);
  expect("nees_coverage", 1.0 / 3.0, 3);
  expect("nees_median", std::numeric_limits<double>::infinity(), 3);  // 4 and twice infinity
  expect("rotation_error_deg", 0.5, 1);                               // of successes
}

// Four problems of ten, the others were not measured: within the bounds, beyond the one of the rotation (3
// deg), beyond the one of the direction (15 deg), and between the two numbers with each of its own.
TEST_F(SummarizeTest, SeverityIsAveragedAndTellsTheImpossible) {
  const double rotation_deg[] = {0.1, 5.1, 0.1, 2.9}, direction_deg[] = {0.5, 0.5, 15.1, 14.9};
  std::vector<ProblemRecord> problems(4);
  std::vector<TrialRecord> records;
  for (std::uint32_t i = 0; i < 4; ++i) {
    problems[i].trial = i;
    problems[i].num_inliers_true = 30.0 + 10.0 * i;
    problems[i].severity.crb_rotation_deg = rotation_deg[i];
    problems[i].severity.crb_direction_deg = direction_deg[i];
    records.push_back(Motion(i, 1.0, 1.0, 1.0));
  }
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("severe"), MakePlan(study_));
    store.Add(problems, records);
  }
  for (const SummaryRow& row : SummarizeRun("severe").rows) {
    if (row.condition != 0 || row.estimator != kSceneLabel) continue;
    if (row.quantity == "impossible") {
      EXPECT_EQ(row.value, 0.5);
    } else if (row.quantity == "num_inliers_true") {
      EXPECT_EQ(row.value, 45.0);
    } else if (row.quantity == "crb_rotation_deg") {
      EXPECT_NEAR(row.value, 2.05, 1e-12);
    } else if (row.quantity == "planarity") {
      EXPECT_EQ(row.n, 0);  // unknown
    }
  }
  EXPECT_NE(SummaryAsTable(SummarizeRun("severe")).find("50.00 % [6.76, 93.24]"), std::string::npos);
}

// Twelve problems with the numbers 11, 10, ..., 0, the last two unknown; of the two hardest the rotation is
// off by 5 deg.
TEST_F(SummarizeTest, FifthsOfANumberOfTheProblem) {
  std::vector<ProblemRecord> problems(12);
  std::vector<TrialRecord> records;
  for (std::uint32_t i = 0; i < 12; ++i) {
    problems[i].trial = i;
    if (i < 10) problems[i].severity.crb_direction_deg = 11.0 - i;
    records.push_back(Motion(i, i < 2 ? 5.0 : 1.0, 1.0, 1.0));
  }
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("fifths"), MakePlan(study_));
    store.Add(problems, records);
  }
  const ResultStore store = ResultStore::OpenForReading(folder_.Path("fifths"));
  const Summary summary = Summarize(ReadRun(store), false, GroupByFifth(store, "crb_direction_deg"));
  EXPECT_EQ(summary.factor_names, (std::vector<std::string>{"fifth", "crb_direction_deg"}));
  const std::vector<std::string> fifths = {"1", "2", "3", "4", "5", "unknown"},
                                 levels = {"up to 3", "3 to 5", "5 to 7", "7 to 9", "above 9", "unknown"};
  std::vector<double> failed;
  for (const SummaryRow& row : summary.rows) {
    if (row.quantity != "failure") continue;
    EXPECT_EQ(row.n, 2) << row.condition;
    EXPECT_EQ(summary.levels.at(row.condition),
              (std::vector<std::string>{fifths.at(row.condition), levels.at(row.condition)}));
    failed.push_back(row.value);
  }
  EXPECT_EQ(failed, (std::vector<double>{0, 0, 0, 0, 1, 0}));
  EXPECT_THROW(GroupByFifth(store, "parallax"), InputError);
  EXPECT_THROW(GroupByFifth(store, "planarity"), InputError) << "of no trial";
}

TEST_F(SummarizeTest, TrialsThatStoppedByTheirOutcomesHaveAnytimeValidIntervals) {
  ResultStore::OpenForRun(folder_.Path("run"), MakePlan(study_)).NoteStoppingRule("a reason");
  const SummaryRow row = Row("failure");
  EXPECT_EQ(row.interval_kind, IntervalKind::kAnytimeValid);
  EXPECT_EQ(row.interval.lower, ConfidenceSequence(2, 10).lower);
  EXPECT_EQ(row.interval.upper, ConfidenceSequence(2, 10).upper);
  EXPECT_LT(row.interval.lower, ExactBinomialInterval(2, 10).lower);
  // Scores have such intervals anyway, medians none.
  EXPECT_EQ(Row("auc_10_deg").interval_kind, IntervalKind::kBetting);
  EXPECT_TRUE(std::isnan(Row("max_error_median_deg_answered").interval.lower));
}

// Failures of weight 0.5 and 0.25 in four trials: (0.5 + 0.25) / 4.
TEST_F(SummarizeTest, WeightedTrialsGiveWeightedRatesAndNoMeans) {
  std::vector<ProblemRecord> problems(4);
  const double weights[] = {0.5, 0.25, 2.0, 1.25};
  for (std::uint32_t i = 0; i < 4; ++i) {
    problems[i].trial = i;
    problems[i].weight = weights[i];
  }
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("weighted"), MakePlan(study_));
    store.Add(problems, {Motion(0, 9.0, 1.0, 1.0), Motion(1, 9.0, 1.0, 1.0), Motion(2, 1.0, 1.0, 1.0),
                         NoMotion(3, MotionStatus::kNoCandidate)});
  }
  for (const SummaryRow& row : SummarizeRun("weighted").rows) {
    if (row.condition != 0 || row.estimator != "standard") continue;
    EXPECT_EQ(row.interval_kind, IntervalKind::kWeighted);
    if (row.quantity == "failure") {
      EXPECT_DOUBLE_EQ(row.value, 0.1875);
      EXPECT_GT(row.standard_error, 0.0);
      EXPECT_LT(row.interval.lower, 0.1875);
      EXPECT_EQ(row.interval.upper, 1.0);  // four trials bound nothing
    } else if (row.kind == SummaryRow::Kind::kArea) {
      ADD_FAILURE() << row.quantity.text() << " of weighted trials";
    } else if (row.kind != SummaryRow::Kind::kRate || row.quantity == "kappa_flag") {
      EXPECT_EQ(row.n, 0) << row.quantity.text();  // a mean, or of a part of the trials
    }
  }
}

// Their pooled trials are not independent.
TEST_F(SummarizedRun, ConditionsThatShareTheirScenesAreNotPooled) {
  study_.common_scenes = true;
  Write("common", HandMadeRecords());
  const ResultStore store = ResultStore::OpenForReading(folder_.Path("common"));
  EXPECT_TRUE(ThrowsInputError([&] { Summarize(store, false, Pooling::kPooled); }, {"common_scenes"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { Compare(store, "", {.pooling = Pooling::kPooled}); }, {"common_scenes"}));
  EXPECT_NO_THROW(Summarize(store, false, Pooling::kPerCondition));
}

// Nor are conditions whose numbers of trials the outcomes chose: the pooled rate would depend on the rule.
TEST_F(SummarizedRun, ConditionsOfAStoppingRuleAreNotPooled) {
  Write("until", HandMadeRecords());
  ResultStore::OpenForRun(folder_.Path("until"), MakePlan(study_)).NoteStoppingRule("ci=0.1");
  const ResultStore store = ResultStore::OpenForReading(folder_.Path("until"));
  EXPECT_TRUE(ThrowsInputError([&] { Summarize(store, false, Pooling::kPooled); }, {"--until"}));
  EXPECT_TRUE(ThrowsInputError([&] { Compare(store, "", {.pooling = Pooling::kPooled}); }, {"--until"}));
  EXPECT_NO_THROW(Summarize(store, false, Pooling::kPerCondition));
}

}  // namespace
}  // namespace rcme
