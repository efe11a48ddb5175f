#include "experiments/statistics/report_findings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rcme {
namespace {

using testing::HasSubstr;

SummaryRow Failure(std::uint32_t condition, const std::string& level, const std::string& label,
                   double value) {
  SummaryRow row;
  row.condition = condition;
  row.levels = {level};
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

TEST(FindingsOf, NamesTheEndsOfEveryRangeAndCountsWhatTheTestsTell) {
  Summary summary;
  summary.factor_names = {"outlier_ratio"};
  summary.rows = {Failure(0, "0.1", "standard", 0.02), Failure(0, "0.1", "ours", 0.05),
                  Failure(1, "0.4", "standard", 0.3), Failure(1, "0.4", "ours", 0.05)};
  Comparison comparison;
  comparison.reference = "standard";
  comparison.rows = {Difference(0, "failure", 0.03, 0.2), Difference(1, "failure", -0.25, 1e-6),
                     Difference(1, "refusal", 0.1, 0.001)};
  const std::vector<std::string> sentences = FindingsOf(summary, comparison);
  ASSERT_EQ(sentences.size(), 3u);
  EXPECT_EQ(sentences[0],
            "Failure rate of standard: from 2 % [1, 4] at outlier_ratio 0.1 to 30 % [15, 60] at "
            "outlier_ratio 0.4.");
  EXPECT_EQ(sentences[1], "Failure rate of ours: 5 % [2.5, 10] at outlier_ratio 0.1 throughout.");
  EXPECT_THAT(sentences[2],
              HasSubstr("Against standard on the same trials ours fails less often in 1 and more often in 0, "
                        "refuses less often in 0 and more often in 1 of the 2 conditions (McNemar"));
}

TEST(FindingsOf, SaysNothingOfNothing) { EXPECT_TRUE(FindingsOf({}, {}).empty()); }

}  // namespace
}  // namespace rcme
