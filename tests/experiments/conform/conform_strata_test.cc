#include "experiments/conform/conform_strata.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/conform/conform_output.h"
#include "experiments/conform/conform_tables.h"
#include "stats/constants.h"
#include "stats/distributions.h"

namespace rcme {
namespace {

// 40 answers: i matches; NEES small enough for the stated region from the 20th on, for four times its
// covariance in all but the first five.
ConformReport ReportByHand() {
  ConformReport report;
  const double quantile = ChiSquareQuantile(5, 0.95);
  for (int i = 0; i < 40; ++i) {
    JudgedAnswer answer;
    answer.row.group = i;
    answer.row.features.fill(kNaN);
    answer.row.features[static_cast<size_t>(VisibleFeature::kMatches)] = std::log1p(10.0 + i);
    answer.row.features[static_cast<size_t>(VisibleFeature::kParallax)] = i == 7 ? kNaN : std::log(0.5 + i);
    answer.row.nees = quantile * (i >= 20 ? 0.5 : i >= 5 ? 3.0 : 5.0);
    answer.row.log_det = 10.0 * std::log(1e-3 * (1 + i));
    answer.verdict.factor = 4.0;
    report.judged.push_back(answer);
    report.problems.push_back({i, false});
  }
  return report;
}

TEST(ConformStrata, QuartersOfWhatIsVisible) {
  const std::vector<CoverageStratum> strata = MeasureConformStrata(ReportByHand());
  // Two regions by matches in four quarters, by parallax in four and the unknown one.
  ASSERT_EQ(strata.size(), 2u * (4 + 5));
  const double stated[] = {0.0, 0.0, 1.0, 1.0}, conformed[] = {0.5, 1.0, 1.0, 1.0};
  for (size_t q = 0; q < 4; ++q) {
    const CoverageStratum &of_stated = strata[q], &of_conformed = strata[9 + q];
    EXPECT_EQ(of_stated.label, "stated");
    EXPECT_EQ(of_conformed.label, "conformed");
    EXPECT_EQ(of_stated.seen, "matches");
    EXPECT_NEAR(of_stated.least, 10.0 + 10.0 * static_cast<double>(q), 1e-9);
    EXPECT_NEAR(of_stated.most, 19.0 + 10.0 * static_cast<double>(q), 1e-9);
    EXPECT_EQ(of_stated.n, 10);
    EXPECT_EQ(of_stated.coverage.value, stated[q]) << q;
    EXPECT_EQ(of_conformed.coverage.value, conformed[q]) << q;
    // Axes sqrt(quantile) sigma: the median of ten neighbours is that of the middle two.
    const double sigma_deg = kDegPerRad * 1e-3 * (5.5 + 10.0 * static_cast<double>(q));
    const double radius = std::sqrt(ChiSquareQuantile(5, 0.95));
    EXPECT_NEAR(of_stated.sharpness[0], sigma_deg * radius, 1e-9) << q;
    EXPECT_NEAR(of_conformed.sharpness[0], 2.0 * sigma_deg * radius, 1e-9) << q;
  }
  EXPECT_EQ(strata[4].seen, "parallax_over_noise");
  EXPECT_NEAR(strata[4].least, 0.5, 1e-12);
  EXPECT_EQ(strata[8].quarter, 0);
  EXPECT_EQ(strata[8].n, 1);
}

// Only where it is asked for, and without a verdict at another level than 95 %.
TEST(ConformStrata, ArePrintedWithTheirSize) {
  ConformReport report = ReportByHand();
  EXPECT_EQ(ConformAsText(report).find("parallax_over_noise"), std::string::npos);
  EXPECT_FALSE(nlohmann::json::parse(ConformAsJson(report)).contains("by_strata"));
  EXPECT_NE(ConformAsText(report, true).find("parallax_over_noise"), std::string::npos);
  const nlohmann::json rows = nlohmann::json::parse(ConformAsJson(report, true))["by_strata"];
  ASSERT_EQ(rows.size(), 18u);
  EXPECT_EQ(rows[0]["verdict"], "too narrow");
  EXPECT_GT(rows[0]["size_deg"], 0.0);
  report.rule.level = 0.9;
  for (const CoverageStratum& stratum : MeasureConformStrata(report)) EXPECT_EQ(stratum.coverage.note, "");
}

}  // namespace
}  // namespace rcme
