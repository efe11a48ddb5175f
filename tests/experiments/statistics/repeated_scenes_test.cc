// The summary of a run with several trials per scene.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/statistics/summarize.h"
#include "experiments/statistics/summary_output.h"
#include "stats/score_mean.h"
#include "stats/variance_split.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

// Scenes of three trials each: s a success, f a failure, r a refusal, u a motion whose truth is not known. In
// trial order; the last scene may be cut off.
class RepeatedScenesTest : public SummarizedRun {
 protected:
  void WriteScenes(const std::string& letters) {
    study_.repeats_per_scene = 3;
    std::vector<TrialRecord> records;
    for (const char letter : letters) {
      const auto trial = static_cast<std::uint32_t>(records.size());
      const double error_deg = letter == 's' ? 1.0 : letter == 'f' ? 10.0 : kNaN;
      records.push_back(letter == 'r' ? NoMotion(trial, MotionStatus::kNoCandidate)
                                      : Motion(trial, error_deg, letter == 'u' ? kNaN : 1.0, 5.0));
    }
    Write("repeated", records);
  }
  SummaryRow FindRow(const std::string& quantity, const std::string& estimator = "standard") {
    for (const SummaryRow& row : SummarizeRun("repeated", true).rows) {
      if (row.quantity == quantity && row.condition == 0 && row.estimator == estimator) return row;
    }
    ADD_FAILURE() << "no row of " << quantity;
    return {};
  }
};

TEST_F(RepeatedScenesTest, ASceneCountsOnceWithTheMeanOfItsTrials) {
  WriteScenes(
      "sss"
      "sff"
      "fff"
      "rsr"
      "ss");
  const auto expect = [&](const std::string& quantity, const std::vector<double>& means) {
    ScoreMean expected;
    for (const double mean : means) expected.Add(mean);
    const SummaryRow row = FindRow(quantity);
    EXPECT_EQ(row.n, static_cast<std::int64_t>(means.size())) << quantity;
    EXPECT_NEAR(row.value, expected.mean(), 1e-12) << quantity;
    EXPECT_NEAR(row.interval.lower, expected.Sequence().lower, 1e-9) << quantity;
    EXPECT_NEAR(row.interval.upper, expected.Sequence().upper, 1e-9) << quantity;
    EXPECT_EQ(row.interval_kind, IntervalKind::kBetting) << quantity;
  };
  expect("failure", {0.0, 2.0 / 3.0, 1.0, 0.0, 0.0});
  expect("no_candidate", {0.0, 0.0, 0.0, 2.0 / 3.0, 0.0});
  expect("auc_20_deg", {0.95, (0.95 + 0.5 + 0.5) / 3.0, 0.5, 0.95 / 3.0, 0.95});
  expect("auc_20_deg_answered", {0.95, (0.95 + 0.5 + 0.5) / 3.0, 0.5, 0.95, 0.95});
  const SummaryRow rotation = FindRow("rotation_error_deg");  // of successes: 1 in every scene but one
  EXPECT_EQ(rotation.n, 4);
  EXPECT_EQ(rotation.value, 1.0);
  EXPECT_EQ(FindRow("max_error_median_deg").n, 5) << "first trials";
  EXPECT_EQ(FindRow("max_error_median_deg").value, 1.0);  // 1, 1, 10, refused, 1
  EXPECT_EQ(FindRow("num_inliers_true", kSceneLabel).n, 5);
  EXPECT_EQ(FindRow("not_scored").n, 5);
}

TEST_F(RepeatedScenesTest, ScenesOfBothOutcomesAndSharesAreThoseOfWholeScenes) {
  // 12 scenes that never fail, 10 that always do, 14 of both kinds; one that is not scored, one cut off.
  std::string letters;
  for (int i = 0; i < 12; ++i) letters += "sss";
  for (int i = 0; i < 10; ++i) letters += "fff";
  for (int i = 0; i < 14; ++i) letters += i % 2 == 0 ? "sfs" : "ffs";
  WriteScenes(letters + "suf" + "fs");
  RepeatedEvents expected(3);
  for (int i = 0; i < 12; ++i) expected.AddScene(0);
  for (int i = 0; i < 10; ++i) expected.AddScene(3);
  for (int i = 0; i < 14; ++i) expected.AddScene(1 + i % 2);
  const VarianceSplit split = expected.Split();
  const SummaryRow within = FindRow("failure_within_scenes"), between = FindRow("failure_between_scenes"),
                   flips = FindRow("failure_flips");
  EXPECT_EQ(within.kind, SummaryRow::Kind::kVarianceShare);
  EXPECT_EQ(within.interval_kind, IntervalKind::kLogStudent);
  EXPECT_EQ(within.n, 36);
  EXPECT_EQ(within.value, split.within_share);
  EXPECT_EQ(within.interval.lower, split.within_share_interval.lower);
  EXPECT_EQ(between.value, 1.0 - split.within_share);
  EXPECT_EQ(between.interval.upper, 1.0 - split.within_share_interval.lower);
  EXPECT_EQ(flips.value, 14.0 / 36.0);
  EXPECT_EQ(flips.n, 36);
  EXPECT_EQ(flips.interval_kind, IntervalKind::kExact);
  EXPECT_EQ(flips.interval.upper, ExactBinomialInterval(14, 36).upper);
  EXPECT_EQ(FindRow("refusal_flips").value, 0.0);
  EXPECT_EQ(FindRow("refusal_flips").n, 37) << "a refusal needs no truth";
  EXPECT_EQ(FindRow("refusal_within_scenes").n, 0) << "nothing varies";
  const std::string table = SummaryAsTable(SummarizeRun("repeated"));
  for (const std::string part :
       {"3 trials per scene", "failure_between_scenes", "depends on the sampler's seed",
        "standard: 38.89 % [23.14, 56.54] of the scenes at outlier_ratio 0", "n counts scenes",
        "estimator  scenes  failure"})
    EXPECT_NE(table.find(part), std::string::npos) << part << " is not in\n" << table;
  EXPECT_EQ(nlohmann::json::parse(SummaryAsJson(SummarizeRun("repeated")))["repeats_per_scene"], 3);
}

TEST_F(RepeatedScenesTest, WithoutRepeatsNothingOfThisIsThere) {
  for (const SummaryRow& row : SummarizeRun("run").rows)
    EXPECT_EQ(row.quantity.text().find("_flips"), std::string::npos);
  EXPECT_EQ(SummaryAsTable(SummarizeRun("run")).find("sampler"), std::string::npos);
}

}  // namespace
}  // namespace rcme
