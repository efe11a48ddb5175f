#include "experiments/statistics/report_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rcme {
namespace {

using testing::HasSubstr;

// Of the first condition with 0.1, of the second with 0.4.
Summary MakeSummary(const std::vector<SummaryRow>& rows) {
  Summary summary;
  summary.factor_names = {"outlier_ratio"};
  summary.levels = {{"0.1"}, {"0.4"}};
  summary.rows = rows;
  return summary;
}

SummaryRow Failure(std::uint32_t condition, const std::string& label, double value) {
  SummaryRow row;
  row.condition = condition;
  row.estimator = label;
  row.quantity = "failure";
  row.value = value;
  row.interval = {value / 2.0, std::min(1.0, 2.0 * value)};
  row.n = 100;
  return row;
}

ComparisonRow Difference(std::uint32_t condition, const std::string& event, double difference, double p) {
  ComparisonRow row;
  row.condition = condition;
  row.estimator = "ours";
  row.event = event;
  row.difference = difference;
  row.holm_p_value = p;
  return row;
}

SummaryRow Rate(const std::string& quantity, const std::string& label, std::uint32_t condition, double value,
                double half_width) {
  SummaryRow row = Failure(condition, label, value);
  row.quantity = quantity;
  row.interval = {value - half_width, value + half_width};
  return row;
}

TEST(ListFindings, NamesTheEndsOfEveryRangeAndWhatTheTestsTell) {
  const Summary summary = MakeSummary({Failure(0, "standard", 0.02), Failure(0, "ours", 0.05),
                                       Failure(1, "standard", 0.3), Failure(1, "ours", 0.05)});
  Comparison comparison;
  comparison.reference = "standard";
  comparison.factor_names = summary.factor_names;
  comparison.rows = {Difference(0, "failure", 0.03, 0.2), Difference(1, "failure", -0.25, 1e-6),
                     Difference(1, "refusal", 0.1, 0.001)};
  comparison.rows[1].levels = {"0.4"};
  comparison.rows[1].interval = {-0.3, -0.2};
  const std::vector<std::string> sentences = ListFindings(summary, comparison, {});
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_THAT(sentences[0],
              HasSubstr("Against standard on the same trials ours fails less often in 1 (by -25.00 points "
                        "[-30.00, -20.00] at outlier_ratio 0.4), refuses more often in 1"));
  EXPECT_THAT(sentences[0], HasSubstr("of the 2 conditions (McNemar"));
  EXPECT_EQ(
      sentences[1],
      "Failure rate of standard: from 2.00 % [1.00, 4.00] at outlier_ratio 0.1 to 30.00 % [15.00, 60.00] at "
      "outlier_ratio 0.4.");
  EXPECT_EQ(sentences[2], "Failure rate of ours: 5.00 % [2.50, 10.00] throughout.");
}

TEST(ListFindings, WhatMattersMostComesFirst) {
  const Summary summary =
      MakeSummary({Rate("failure", "a", 0, 0.05, 0.01), Rate("no_candidate", "a", 0, 0.5, 0.05),
                   Rate("nees_coverage", "a", 0, 0.8, 0.05), Rate("nees_coverage", "b", 0, 0.05, 0.02),
                   Rate("nees_coverage", "c", 0, 0.93, 0.01), Rate("other_refusal", "b", 0, 0.05, 0.01),
                   Rate("nees_coverage", "b", 1, 0.95, 0.02)});
  Comparison comparison;
  comparison.reference = "c";
  comparison.rows = {Difference(0, "failure", 0.03, 0.2)};
  ForecastMeasures forecast;
  forecast.estimator = "a";
  forecast.n = 100;
  forecast.mean_probability = 0.1;
  forecast.failure.value = 0.2;
  forecast.failure.interval = {0.15, 0.25};
  const std::vector<std::string> sentences = ListFindings(summary, comparison, {forecast});
  ASSERT_EQ(sentences.size(), 6u);
  EXPECT_EQ(sentences[0],
            "Coverage: the 95 % regions that b states contain the truth in 5.00 % [3.00, 7.00] at "
            "outlier_ratio 0.1: "
            "they are too small, and far off in 1 of 2 conditions.");
  EXPECT_THAT(sentences[1], HasSubstr("regions that a states contain the truth in 80.00 %"));
  EXPECT_THAT(sentences[2], HasSubstr("Against c no difference in failures or refusals is decided of ours"));
  EXPECT_EQ(sentences[3],
            "Probability: a states a probability of failure of 10.00 % on average, and 20.00 % [15.00, "
            "25.00] of its "
            "answers failed: it is too sure.");
  EXPECT_EQ(sentences[4],
            "Refusals: a refuses up to 50.00 % [45.00, 55.00] at outlier_ratio 0.1 (no_candidate).");
  EXPECT_THAT(sentences[5], HasSubstr("Failure rate of a"));
}

TEST(ListFindings, ACoverageIsNotSaidWithoutItsSharpness) {
  SummaryRow sharpness = Rate("sd_over_crb", "a", 0, 0.62, 0.1);
  sharpness.kind = SummaryRow::Kind::kMedian;
  const Summary summary = MakeSummary(
      {Rate("nees_coverage", "a", 0, 0.8, 0.05), sharpness, Rate("sd_over_crb", "a", 1, 0.9, 0.1)});
  const std::vector<std::string> sentences = ListFindings(summary, {}, {});
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_EQ(
      sentences[0],
      "Coverage: the 95 % regions that a states contain the truth in 80.00 % [75.00, 85.00] at outlier_ratio "
      "0.1, with an sd of 0.62 times the Cramer-Rao bound: they are too small.");
}

TEST(ListFindings, NamesThePopulation) {
  Summary summary = MakeSummary({Rate("nees_coverage", "ours", 0, 0.8, 0.05), Failure(0, "ours", 0.05),
                                 Rate("no_candidate", "ours", 0, 0.5, 0.05)});
  summary.study = "any_room";
  summary.is_of_population = true;
  summary.factor_names.clear();
  summary.levels = {{}};
  Comparison comparison;
  comparison.reference = "standard";
  comparison.rows = {Difference(0, "failure_or_refusal", -0.02, 0.2)};
  comparison.rows[0].n = 100;
  const std::vector<std::string> sentences = ListFindings(summary, comparison, {});
  ASSERT_EQ(sentences.size(), 4u);
  for (const std::string& sentence : sentences)
    EXPECT_THAT(sentence, testing::ContainsRegex("[Oo]ver the population of study any_room"));
}

TEST(ListFindings, TheOneAheadComesBeforeTheOneBehind) {
  Comparison comparison;
  comparison.reference = "c";
  comparison.rows = {Difference(0, "failure", 0.3, 0.001), Difference(0, "failure", -0.2, 0.001)};
  comparison.rows[0].estimator = "behind";
  const std::vector<std::string> sentences = ListFindings({}, comparison, {});
  ASSERT_EQ(sentences.size(), 2u);
  EXPECT_THAT(sentences[0], HasSubstr("ours fails less often"));
  EXPECT_THAT(sentences[1], HasSubstr("behind fails more often"));
}

TEST(ListFindings, RightProbabilitiesAndSmallSamplesAreNoFinding) {
  const Summary summary = MakeSummary({Rate("nees_coverage", "a", 0, 0.8, 0.15)});
  ForecastMeasures forecast;
  forecast.n = 100;
  forecast.mean_probability = 0.2;
  forecast.failure.value = 0.2;
  forecast.failure.interval = {0.15, 0.25};
  EXPECT_TRUE(ListFindings(summary, {}, {forecast}).empty());
}

TEST(ListFindings, ACoverageOfFewAnswersIsNoFinding) {
  SummaryRow few = Rate("nees_coverage", "a", 0, 0.0, 0.0);
  few.interval = {0.0, 0.5};
  few.n = 9;
  EXPECT_TRUE(ListFindings(MakeSummary({few}), {}, {}).empty());
  few.n = 10;
  EXPECT_EQ(ListFindings(MakeSummary({few}), {}, {}).size(), 1u);
}

// Of ten coverages and two refusals both refusals are kept.
TEST(ListFindings, AtMostEightAreListedOfAllKinds) {
  std::vector<SummaryRow> rows;
  for (const std::string label : {"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"})
    rows.push_back(Rate("nees_coverage", label, 0, 0.1, 0.05));
  rows.push_back(Rate("no_candidate", "a", 0, 0.5, 0.05));
  rows.push_back(Rate("no_candidate", "b", 0, 0.4, 0.05));
  const std::vector<std::string> sentences = ListFindings(MakeSummary(rows), {}, {});
  ASSERT_EQ(sentences.size(), 9u);
  EXPECT_THAT(sentences[5], HasSubstr("Coverage"));
  EXPECT_THAT(sentences[6], HasSubstr("Refusals: a"));
  EXPECT_THAT(sentences[7], HasSubstr("Refusals: b"));
  EXPECT_EQ(sentences[8], "And 4 more in the tables.");
}

TEST(ListFindings, SaysNothingOfNothing) { EXPECT_TRUE(ListFindings({}, {}, {}).empty()); }

}  // namespace
}  // namespace rcme
