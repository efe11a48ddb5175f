// The summary of a run of hand-made records.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "stats/constants.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

inline TrialRecord Motion(std::uint32_t trial, double rotation_deg, double direction_deg, double nees) {
  TrialRecord record;
  record.trial = trial;
  record.status = MotionStatus::kOk;
  record.rotation_error_deg = rotation_deg;
  record.direction_error_deg = direction_deg;
  record.nees = nees;
  record.density.kind = static_cast<int>(StatedDensity::Kind::kRegular);
  record.density.rotation_sd_deg = 0.5 + trial;
  record.density.direction_sd_deg = 2.0 * (0.5 + trial);
  record.density.sd_over_crb = 1.0 + trial;
  record.density.log_det_cov = -50.0;
  record.density.energy_score_deg = 0.5 * rotation_deg;
  record.density.log_score = nees - 20.0;
  record.density.rotation_level_deg = 1.0 + trial;
  record.density.direction_level_deg = 2.0 * trial;
  record.inlier_precision = 0.5;
  record.inlier_recall = 0.25;
  record.num_matches = 40;
  record.num_support = 10 + static_cast<int>(trial);
  record.num_explained = 20;
  record.mean_entropy = -4.0;
  record.counts.num_candidates = 3;
  record.seconds = 0.002;
  return record;
}

inline TrialRecord NoMotion(std::uint32_t trial, MotionStatus status) {
  TrialRecord record;
  record.trial = trial;
  record.status = status;
  record.rotation_error_deg = record.direction_error_deg = record.nees = kNaN;
  record.inlier_precision = record.inlier_recall = record.mean_entropy = record.z_statistic = kNaN;
  record.seconds = 0.004;
  return record;
}

// Condition 0, estimator 0 ("standard"), ten trials: four successes, two failures, four without a motion.
inline std::vector<TrialRecord> HandMadeRecords() {
  std::vector<TrialRecord> records = {
      Motion(0, 1.0, 2.0, 4.0),
      Motion(1, 2.0, 4.0, 6.0),
      Motion(2, 3.0, 15.0, 20.0),  // at both bounds: a success; outside of the 95 % region (11.07)
      Motion(3, 2.0, 3.0, 2.0),
      Motion(4, 3.5, 1.0, 30.0),  // fails by its rotation
      Motion(5, 1.0, 40.0, 3.0),  // fails by its direction
      NoMotion(6, MotionStatus::kNoCandidate),
      NoMotion(7, MotionStatus::kNoCandidate),
      NoMotion(8, MotionStatus::kRefinementDiverged),
      NoMotion(9, MotionStatus::kTooFewMatches),
  };
  records[5].failed_by_kappa = true;
  records[3].inlier_precision = 1.0;
  return records;
}

// A run of ten trials with known summaries, and others that a test writes.
class SummarizedRun : public testing::Test {
 protected:
  SummarizedRun() {
    study_.estimators.resize(1);  // "standard"
    Write("run", HandMadeRecords());
  }

  void Write(const std::string& name, const std::vector<TrialRecord>& records) {
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), MakePlan(study_));
    AddRecords(store, records);
  }
  Summary SummarizeRun(const std::string& name, bool with_times = false) {
    return Summarize(ResultStore::OpenForReading(folder_.Path(name)), with_times);
  }
  SummaryRow Row(const std::string& quantity, std::uint32_t condition = 0,
                 const std::string& estimator = "standard") {
    for (const SummaryRow& row : SummarizeRun("run", true).rows) {
      if (row.quantity == quantity && row.condition == condition && row.estimator == estimator) return row;
    }
    ADD_FAILURE() << "no row of " << quantity;
    return {};
  }
  void ExpectRate(const std::string& quantity, std::int64_t count, std::int64_t n) {
    const SummaryRow row = Row(quantity);
    EXPECT_EQ(row.kind, SummaryRow::Kind::kRate) << quantity;
    EXPECT_EQ(row.n, n) << quantity;
    EXPECT_DOUBLE_EQ(row.value, static_cast<double>(count) / static_cast<double>(n)) << quantity;
    EXPECT_EQ(row.interval.lower, ExactBinomialInterval(count, n).lower) << quantity;
    EXPECT_EQ(row.interval.upper, ExactBinomialInterval(count, n).upper) << quantity;
  }
  void ExpectMean(const std::string& quantity, const std::vector<double>& values) {
    double mean = 0.0, sum_squares = 0.0;
    const double n = static_cast<double>(values.size());
    for (const double value : values) mean += value / n;
    for (const double value : values) sum_squares += (value - mean) * (value - mean);
    const SummaryRow row = Row(quantity);
    EXPECT_EQ(row.kind, SummaryRow::Kind::kMean) << quantity;
    EXPECT_EQ(row.n, static_cast<std::int64_t>(values.size())) << quantity;
    EXPECT_NEAR(row.value, mean, 1e-12) << quantity;
    EXPECT_NEAR(row.standard_error, std::sqrt(sum_squares / (n - 1.0) / n), 1e-12) << quantity;
  }

  TempFolder folder_;
  Study study_ = SmallStudy();
};

}  // namespace rcme
