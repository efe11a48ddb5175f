#include "experiments/statistics/marginals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "experiments/core/table/render_table.h"
#include "experiments/statistics/marginals_output.h"
#include "stats/random.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/summarized_run.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// 24 outlier ratios, which are divided into fifths, times two numbers of matches.
Study WideStudy() {
  std::string ratios;
  for (int i = 0; i < 24; ++i) ratios += fmt::format("{}{}", i == 0 ? "" : ", ", 0.02 * i);
  return ParseStudy(
      "name: wide\nseed: 1\ntrials: 40\n"
      "data: {scene: uniform_volume, sigma_px: 0.5}\n"
      "factors:\n  outlier_ratio: [" +
          ratios +
          "]\n  num_matches: [50, 60]\n"
          "estimators:\n  - {name: standard}\n",
      "wide.yaml");
}

// The draws 0, ..., 23 of a population, as a sample or as chosen draws.
Study StudyOfDraws(bool are_chosen) {
  std::string numbers = "0";
  for (int i = 1; i < 24; ++i) numbers += fmt::format(", {}", i);
  return ParseStudy(
      "name: drawn\nseed: 1\ntrials: 40\n"
      "data: {scene: uniform_volume, sigma_px: 0.5}\n"
      "conditions:\n  number: 24\n  ranges: {outlier_ratio: [0, 0.5]}\n" +
          (are_chosen ? "  draws: [" + numbers + "]\n" : "") + "estimators:\n  - {name: standard}\n",
      "drawn.yaml");
}

// Answers with a stated probability of .2 that fail as often as `rate` says, in each condition.
class MarginalsOfRun : public testing::Test {
 protected:
  template <typename Rate>
  Marginals Measure(Rate rate, bool with_pairs = false, double stated = 0.2) {
    const StudyPlan plan = MakePlan(study_);
    ResultStore store = ResultStore::OpenForRun(folder_.Path(fmt::format("{}.sqlite", number_++)), plan);
    RandomStream rng({1, number_, 0, 0});
    for (const Condition& condition : plan.conditions) {
      std::vector<TrialRecord> records;
      for (std::uint32_t trial = 0; trial < 40; ++trial) {
        TrialRecord record = Motion(trial, rng.Uniform() < rate(condition) ? 90.0 : 0.1, 0.1, 4.0);
        record.condition = condition.index;
        record.failure_probability = stated;
        records.push_back(record);
      }
      AddRecords(store, records);
    }
    store.Commit();
    return MeasureMarginals(store, {.with_pairs = with_pairs, .estimators = {}});
  }

  Study study_ = WideStudy();
  const TempFolder folder_;
  std::uint32_t number_ = 0;
};

bool IsIn(const Condition& condition, double least_ratio, const std::string& num_matches) {
  return std::stod(condition.levels[0]) >= least_ratio && condition.levels[1] == num_matches;
}

TEST_F(MarginalsOfRun, WhereNothingIsWrongNothingIsFound) {
  const Marginals marginals = Measure([](const Condition&) { return 0.2; });
  // All and 5 + 2 regimes; no answer is sure, so that two quantities remain.
  EXPECT_EQ(marginals.num_intervals, 16u);
  for (const Marginal& one : marginals.rows) {
    EXPECT_EQ(one.excess, 0.0) << one.regime;
    EXPECT_TRUE(std::isnan(one.sd_over_crb)) << one.regime;  // of no coverage
  }
}

// In each condition the trials 0, ..., 39 with 1, ..., 40 times the bound: the geometric mean is 40!^(1 /
// 40).
TEST_F(MarginalsOfRun, ACoverageHasItsSharpness) {
  const Marginals marginals = Measure([](const Condition&) { return 0.0; }, false, 1e-3);
  int num_coverages = 0;
  for (const Marginal& one : marginals.rows) {
    const bool is_coverage = one.quantity == MarginalQuantity::kSureCoverage;
    num_coverages += is_coverage;
    if (is_coverage) {
      EXPECT_NEAR(one.sd_over_crb, std::exp(std::lgamma(41.0) / 40.0), 1e-9) << one.regime;
    } else {
      EXPECT_TRUE(std::isnan(one.sd_over_crb)) << one.regime;
    }
  }
  EXPECT_EQ(num_coverages, 8);
  for (const std::string& text :
       {MakeMarginalsResult("wide", marginals, 3).text, RenderCsv(MakeMarginalsTable(marginals))})
    EXPECT_NE(text.find("sd_over_crb"), std::string::npos);
}

TEST_F(MarginalsOfRun, TheWrongRegimeComesFirst) {
  const Marginals marginals =
      Measure([](const Condition& condition) { return IsIn(condition, 0.29, "60") ? 0.9 : 0.2; }, true);
  const Marginal& worst = marginals.rows.front();
  EXPECT_EQ(worst.quantity, MarginalQuantity::kFailedLessStated);
  EXPECT_NE(worst.regime.find("num_matches = 60"), std::string::npos) << worst.regime;
  EXPECT_NE(worst.regime.find("outlier_ratio 0.3"), std::string::npos) << worst.regime;
  EXPECT_GT(worst.interval.lower, 0.15);
  EXPECT_NEAR(worst.value, 0.7, 0.15);
  for (const Marginal& one : marginals.rows) {
    EXPECT_TRUE(one.excess == 0.0 || one.regime.find("num_matches = 50") == std::string::npos) << one.regime;
  }
  EXPECT_NE(MakeMarginalsResult("wide", marginals, 3).text.find("num_matches = 60"), std::string::npos);
}

// The spread over conditions is zero, but 0 failures of 1,920 trials do not show that they are rarer than
// 1e-4.
TEST_F(MarginalsOfRun, FailuresThatWereNotSeenAreAllowedFor) {
  for (const Marginal& one : Measure([](const Condition&) { return 0.0; }, false, 1e-4).rows) {
    if (one.quantity != MarginalQuantity::kFailedLessStated) continue;
    EXPECT_EQ(one.excess, 0.0) << one.regime;
    EXPECT_GT(one.interval.upper, 0.01) << one.regime;
  }
}

// ... but they show that they are rarer than one in two.
TEST_F(MarginalsOfRun, AnEstimatorThatIsFarTooCautiousIsNamed) {
  const Marginals marginals = Measure([](const Condition&) { return 0.0; }, false, 0.5);
  EXPECT_EQ(marginals.rows.front().quantity, MarginalQuantity::kFailedLessStated);
  EXPECT_GT(marginals.rows.front().excess, 0.0);
}

const Marginal& FindOverall(const Marginals& marginals, MarginalQuantity quantity) {
  const auto found = std::ranges::find_if(
      marginals.rows, [&](const Marginal& one) { return one.regime.empty() && one.quantity == quantity; });
  EXPECT_NE(found, marginals.rows.end());
  return *found;
}

// Every second draw always fails. Over 24 draws of a population the rate 0.5 is known to some +-0.3; that of
// these very draws, from 960 trials, to +-0.05.
TEST_F(MarginalsOfRun, ChosenDrawsAreNoSample) {
  const auto rate = [](const Condition& condition) { return condition.index % 2 == 0 ? 1.0 : 0.0; };
  for (const bool are_chosen : {false, true}) {
    study_ = StudyOfDraws(are_chosen);
    const Marginals marginals = Measure(rate);
    for (const auto quantity : {MarginalQuantity::kFailure, MarginalQuantity::kFailedLessStated}) {
      const Interval interval = FindOverall(marginals, quantity).interval;
      const double width = interval.upper - interval.lower;
      EXPECT_EQ(width < 0.15, are_chosen) << width;
      EXPECT_EQ(width > 0.4, !are_chosen) << width;
    }
    const CommandResult result = MakeMarginalsResult("drawn", marginals, 3);
    EXPECT_EQ(result.text.find("no sample") != std::string::npos, are_chosen) << result.text;
    EXPECT_EQ(result.json.find("these_conditions") != std::string::npos, are_chosen);
  }
}

// All trials succeed, so they do not scatter; an upper end at the mean would be far too low.
TEST_F(MarginalsOfRun, ChosenDrawsAllowForFailuresThatWereNotSeen) {
  study_ = StudyOfDraws(true);
  const Marginals marginals = Measure([](const Condition&) { return 0.0; }, false, 1e-4);
  const Marginal& one = FindOverall(marginals, MarginalQuantity::kFailedLessStated);
  EXPECT_EQ(one.excess, 0.0);
  EXPECT_GT(one.interval.upper, 0.003);
  EXPECT_LT(one.interval.upper, 0.02);
}

TEST_F(MarginalsOfRun, AGridThatSharesScenesIsRefused) {
  study_.common_scenes = true;
  EXPECT_TRUE(ThrowsInputError([&] { Measure([](const Condition&) { return 0.0; }); },
                               {"share their scenes", "common_scenes"}));
}

TEST_F(MarginalsOfRun, OneOrTwoConditionsAreNoRegime) {
  const TempFolder folder;
  const StudyPlan plan = MakePlan(SmallStudy());
  const ResultStore store = ResultStore::OpenForRun(folder.Path("small.sqlite"), plan);
  EXPECT_TRUE(ThrowsInputError([&] { MeasureMarginals(store, {}); }, {"2 conditions; at least 5"}));
}

}  // namespace
}  // namespace rcme
