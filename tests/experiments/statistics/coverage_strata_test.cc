#include "experiments/statistics/coverage_strata.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "experiments/statistics/coverage_strata_output.h"
#include "parameters/input_error.h"
#include "stats/clustered_estimate.h"
#include "stats/constants.h"
#include "tests/test_support/summarized_run.h"

namespace rcme {
namespace {

VisibleAnswers MakeAnswers(const std::vector<double>& seen, const std::vector<bool>& are_covered,
                           const std::vector<double>& sharpness) {
  VisibleAnswers answers;
  answers.label = "ours";
  answers.seen_names = {"matches"};
  answers.sharpness_names = {"sd_over_crb"};
  answers.seen = {seen};
  answers.are_covered = are_covered;
  answers.sharpness = {sharpness};
  for (size_t i = 0; i < seen.size(); ++i) answers.clusters.push_back(static_cast<std::int64_t>(i));
  return answers;
}

TEST(CoverageStrata, QuartersByHand) {
  const std::vector<CoverageStratum> strata = MeasureCoverageStrata(
      MakeAnswers({8, 1, 7, 2, 6, 3, 5, 4}, {true, false, true, false, true, true, true, false},
                  {1.5, 4, 1, 6, 3, kNaN, 2, 5}),
      StrataIntervals::kClusters);
  ASSERT_EQ(strata.size(), 4U);
  const struct {
    double least, most;
    int count;
    double sharpness;
  } kExpected[] = {{1, 2, 0, 5.0}, {3, 4, 1, 5.0}, {5, 6, 2, 2.5}, {7, 8, 2, 1.25}};
  for (size_t q = 0; q < 4; ++q) {
    EXPECT_EQ(strata[q].label, "ours");
    EXPECT_EQ(strata[q].seen, "matches");
    EXPECT_EQ(strata[q].quarter, static_cast<int>(q) + 1);
    EXPECT_EQ(strata[q].least, kExpected[q].least);
    EXPECT_EQ(strata[q].most, kExpected[q].most);
    EXPECT_EQ(strata[q].n, 2);
    EXPECT_EQ(strata[q].coverage.value, kExpected[q].count / 2.0);
    EXPECT_EQ(strata[q].coverage.interval.lower, ExactBinomialInterval(kExpected[q].count, 2).lower);
    EXPECT_EQ(strata[q].coverage.interval.upper, ExactBinomialInterval(kExpected[q].count, 2).upper);
    EXPECT_EQ(strata[q].sharpness, std::vector{kExpected[q].sharpness}) << q;
  }
}

// Equal values are together; unknown ones are apart, and a quantity of one value divides nothing.
TEST(CoverageStrata, TiesAndUnknownValues) {
  const std::vector<bool> all(7, true);
  const std::vector<double> sharp(7, 1.0);
  const std::vector<CoverageStratum> strata =
      MeasureCoverageStrata(MakeAnswers({3, 3, 3, 3, 3, 9, kNaN}, all, sharp), StrataIntervals::kClusters);
  ASSERT_EQ(strata.size(), 3U);
  EXPECT_EQ(strata[0].n, 5);
  EXPECT_EQ(strata[0].most, 3.0);
  EXPECT_EQ(strata[1].n, 1);
  EXPECT_EQ(strata[1].least, 9.0);
  EXPECT_EQ(strata[2].quarter, 0);
  EXPECT_TRUE(std::isnan(strata[2].least));
  EXPECT_TRUE(
      MeasureCoverageStrata(MakeAnswers(std::vector<double>(7, 3.0), all, sharp), StrataIntervals::kClusters)
          .empty());
}

// Answers of a cluster are no independent ones.
TEST(CoverageStrata, IntervalsAreByClusters) {
  std::vector<double> seen;
  std::vector<bool> are_covered;
  for (int i = 0; i < 400; ++i) {
    seen.push_back(i < 200 ? 1.0 : 2.0);
    are_covered.push_back(i % 40 >= 4);
  }
  VisibleAnswers answers = MakeAnswers(seen, are_covered, std::vector<double>(400, 1.0));
  const CoverageStratum apart = MeasureCoverageStrata(answers, StrataIntervals::kClusters).front();
  const CoverageStratum anytime = MeasureCoverageStrata(answers, StrataIntervals::kAnytime).front();
  EXPECT_EQ(apart.coverage.value, 0.9);
  EXPECT_LT(anytime.coverage.interval.lower, apart.coverage.interval.lower);
  for (size_t i = 0; i < 400; ++i) answers.clusters[i] = static_cast<std::int64_t>(i / 4);
  const CoverageStratum together = MeasureCoverageStrata(answers, StrataIntervals::kClusters).front();
  std::vector<double> numbers;
  for (size_t i = 0; i < 200; ++i) numbers.push_back(are_covered[i] ? 1.0 : 0.0);
  const ClusteredEstimate expected =
      MeasureBoundedClusteredMean(numbers, {0.0, 1.0}, std::span(answers.clusters).first(200));
  EXPECT_EQ(together.coverage.interval.lower, expected.interval.lower);
  EXPECT_LT(together.coverage.interval.lower, apart.coverage.interval.lower);
  const CoverageStratum of_population = MeasureCoverageStrata(answers, StrataIntervals::kPopulation).front();
  EXPECT_LT(of_population.coverage.interval.lower, apart.coverage.interval.lower);
}

class StrataOfRun : public SummarizedRun {};

// Of the six answers by the stated sd 0.5, ..., 5.5: NEES 4, 6, 20, 2, 30, 3 against 11.07.
TEST_F(StrataOfRun, ByWhatIsStored) {
  const CoverageStrata strata = MeasureCoverageStrata(ResultStore::OpenForReading(folder_.Path("run")));
  std::vector<CoverageStratum> by_sd;
  for (const CoverageStratum& stratum : strata.rows) {
    EXPECT_NE(stratum.seen, "matches");  // all have 40
    if (stratum.seen == "rotation_sd_deg") by_sd.push_back(stratum);
  }
  ASSERT_EQ(by_sd.size(), 4U);
  const double coverage[] = {1.0, 0.0, 0.5, 1.0}, over_crb[] = {1.5, 3.0, 4.5, 6.0};
  for (size_t q = 0; q < 4; ++q) {
    EXPECT_EQ(by_sd[q].coverage.value, coverage[q]) << q;
    EXPECT_EQ(by_sd[q].sharpness[0], over_crb[q]) << q;
  }
  const CommandResult result = MakeStrataResult("small", strata);
  for (const std::string& format : ListResultFormats()) {
    const std::string text = RenderResult(result, format);
    for (const char* word : {"coverage", "over", "rotation"})
      EXPECT_NE(text.find(word), std::string::npos) << format;
  }
}

TEST_F(StrataOfRun, RefusesWeightedTrials) {
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("weighted"), MakePlan(study_));
    ProblemRecord problem;
    problem.weight = 0.5;
    store.Add({problem}, {Motion(0, 1.0, 1.0, 1.0)});
  }
  EXPECT_THROW(MeasureCoverageStrata(ResultStore::OpenForReading(folder_.Path("weighted"))), InputError);
}

}  // namespace
}  // namespace rcme
