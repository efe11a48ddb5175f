#include "experiments/statistics/population_summary.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "experiments/run/run_study.h"
#include "experiments/statistics/compare.h"
#include "experiments/statistics/count_study.h"
#include "experiments/statistics/forecast_measures.h"
#include "experiments/statistics/scenes_of_run.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/study/study_file.h"
#include "stats/population_mean.h"
#include "stats/population_rate.h"
#include "stats/random.h"
#include "stats/sparsification.h"
#include "tests/test_support/add_records.h"
#include "tests/test_support/summarized_run.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// 12 draws, each with two levels of a factor: 24 conditions.
Study DrawnStudy(const std::string& more = "") {
  return ParseStudy(
      "name: drawn\nseed: 3\ntrials: 5\n"
      "conditions: {number: 12, " +
          more +
          "ranges: {scene: plane, sigma_px: {log: [0.2, 4]}, num_matches: [30, 60]}}\n"
          "factors: {outlier_ratio: [0, 0.5]}\n"
          "estimators: [{name: standard}, {name: msac}]\n",
      "drawn.yaml");
}

// In the trials of draw d the first estimator fails with probability ComputeFailure(d) on every trial, the
// second on half of these.
double ComputeFailure(size_t draw) { return draw % 4 == 0 ? 0.9 : 0.1; }

class PopulationSummary : public testing::Test {
 protected:
  PopulationSummary() {
    const StudyPlan plan = MakePlan(study_);
    ResultStore store = ResultStore::OpenForRun(folder_.Path("run.sqlite"), plan);
    RandomStream rng({1, 2, 0, 0});
    for (const Condition& condition : plan.conditions) {
      const size_t draw = condition.index / 2;
      for (std::uint32_t trial = 0; trial < 5; ++trial) {
        const bool fails = rng.Uniform() < ComputeFailure(draw), other_fails = fails && rng.Uniform() < 0.5;
        std::vector<TrialRecord> records;
        for (const bool has_failed : {fails, other_fails}) {
          TrialRecord record = Motion(trial, has_failed ? 90.0 : 0.1, 0.1, 4.0);
          record.condition = condition.index;
          record.estimator = static_cast<std::uint32_t>(records.size());
          record.failure_probability = 0.3;
          records.push_back(record);
        }
        AddRecords(store, records);
        counts_[draw].num_trials += 1;
        counts_[draw].num_events += fails;
        pairs_[draw].num_trials += 1;
        pairs_[draw].num_second_only += fails && !other_fails;
      }
    }
    store.Commit();
  }

  ResultStore Open() const { return ResultStore::OpenForReading(folder_.Path("run.sqlite")); }

  const TempFolder folder_;
  const Study study_ = DrawnStudy();
  std::vector<ConditionCount> counts_ = std::vector<ConditionCount>(12);
  std::vector<ConditionPair> pairs_ = std::vector<ConditionPair>(12);
};

// One level of a factor has the draws' trials with that level alone: here the first of each draw's two
// conditions.
TEST_F(PopulationSummary, ByAFactorEachLevelHasItsOwnTrials) {
  const ResultStore store = Open();
  const Summary by = SummarizeBy(ReadRun(store), false, "outlier_ratio");
  EXPECT_EQ(by.factor_names, std::vector<std::string>{"outlier_ratio"});
  EXPECT_EQ(by.levels, (std::vector<std::vector<std::string>>{{"0"}, {"0.5"}}));
  EXPECT_EQ(by.num_trials_done, 24 * 5);
  std::vector<ConditionCount> first(12);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.condition % 2 != 0) return;
    first[problem.condition / 2].num_trials += 1;
    first[problem.condition / 2].num_events += HasFailed(records[0], store.Description().failure);
  });
  const PopulationRate expected = MeasurePopulationRate(first, ConditionWeights::kByTrials);
  const auto row = std::ranges::find_if(by.rows, [](const SummaryRow& r) {
    return r.condition == 0 && r.estimator == "standard" && r.quantity == "failure";
  });
  ASSERT_NE(row, by.rows.end());
  EXPECT_EQ(row->n, 60);
  EXPECT_DOUBLE_EQ(row->interval.lower, expected.interval.lower);
  EXPECT_DOUBLE_EQ(row->interval.upper, expected.interval.upper);
  EXPECT_THROW(SummarizeBy(ReadRun(store), false, "sigma"), InputError);
}

// Two groups in the place of fifths: the first two trials of each condition, and the others.
TEST_F(PopulationSummary, GroupsOfTrialsHaveTheIntervalOverDraws) {
  const ResultStore store = Open();
  const TrialGroups groups{{"fifth", "x"}, {{"1", "low"}, {"2", "high"}}, [](const ProblemRecord& problem) {
                             return size_t{problem.trial < 2 ? 0U : 1U};
                           }};
  const Summary fifths = SummarizeFifths(ReadRun(store), false, groups);
  EXPECT_EQ(fifths.levels, groups.levels);
  EXPECT_EQ(fifths.num_trials_done, 24 * 5);
  std::vector<ConditionCount> high(12);
  store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    if (problem.trial < 2) return;
    high[problem.condition / 2].num_trials += 1;
    high[problem.condition / 2].num_events += HasFailed(records[0], store.Description().failure);
  });
  const PopulationRate expected = MeasurePopulationRate(high, ConditionWeights::kByTrials);
  const auto row = std::ranges::find_if(fifths.rows, [](const SummaryRow& r) {
    return r.condition == 1 && r.estimator == "standard" && r.quantity == "failure";
  });
  ASSERT_NE(row, fifths.rows.end());
  EXPECT_EQ(row->n, 72);
  EXPECT_DOUBLE_EQ(row->interval.lower, expected.interval.lower);
  EXPECT_DOUBLE_EQ(row->interval.upper, expected.interval.upper);
}

TEST_F(PopulationSummary, SaysWhereIntervalsAreOfTheDrawsAlone) {
  const StudyPlan plan =
      MakePlan(ParseStudy("name: drawn\nseed: 3\ntrials: 4\nrepeats_per_scene: 2\n"
                          "conditions: {number: 2, ranges: {scene: plane, num_matches: [30, 60]}}\n"
                          "estimators: [{name: standard}, {name: msac}]\n",
                          "repeated.yaml"));
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("repeated.sqlite"), plan);
    for (const Condition& condition : plan.conditions) {
      TrialRecord first = Motion(0, 0.1, 0.1, 4.0), second = first;
      first.condition = second.condition = condition.index;
      second.estimator = 1;
      AddRecords(store, {first, second});
    }
  }
  const ResultStore store = ResultStore::OpenForReading(folder_.Path("repeated.sqlite"));
  const Summary pooled = Summarize(store, false, Pooling::kPooled);
  EXPECT_FALSE(pooled.is_of_population);
  EXPECT_TRUE(pooled.is_of_these_draws);
  EXPECT_NE(SummaryAsTable(pooled).find(kOfTheseDraws), std::string::npos);
  EXPECT_TRUE(Compare(store, "standard", {.pooling = Pooling::kPooled}).is_of_these_draws);
  const Summary of_population = Summarize(Open(), false, Pooling::kPooled);
  EXPECT_EQ(SummaryAsTable(of_population).find(kOfTheseDraws), std::string::npos);
}

TEST(HasCommonScenes, IsTheKeyNotTheDescription) {
  const auto has = [](const std::string& more) {
    return HasCommonScenes(Describe(MakePlan(
        ParseStudy("name: s\ntrials: 1\n" + more + "data: {scene: plane}\nestimators: [{name: standard}]\n",
                   "s.yaml"))));
  };
  EXPECT_TRUE(has("common_scenes: true\n"));
  EXPECT_FALSE(has("description: \"that would be\\ncommon_scenes: true\"\n"));
}

// Of draws, not of conditions, whose two levels of the factor are alike.
TEST_F(PopulationSummary, RatesHaveTheIntervalOverDraws) {
  const Summary pooled = Summarize(Open(), false, Pooling::kPooled);
  ASSERT_TRUE(pooled.is_of_population);
  const PopulationRate expected = MeasurePopulationRate(counts_, ConditionWeights::kByTrials);
  int num_checked = 0;
  for (const SummaryRow& row : pooled.rows) {
    EXPECT_EQ(row.interval_kind, IntervalKind::kPopulation) << row.quantity.text();
    if (row.estimator != "standard" || row.quantity != "failure") continue;
    ++num_checked;
    EXPECT_EQ(row.n, 120);
    EXPECT_DOUBLE_EQ(row.value, expected.value);
    EXPECT_DOUBLE_EQ(row.interval.lower, expected.interval.lower);
    EXPECT_DOUBLE_EQ(row.interval.upper, expected.interval.upper);
    EXPECT_DOUBLE_EQ(row.of_population.value().effective_n, expected.effective_n);
    EXPECT_LT(row.of_population->effective_n, 60.0);
    EXPECT_LT(row.of_population->of_these_conditions.upper, row.interval.upper);
  }
  EXPECT_EQ(num_checked, 1);
  EXPECT_FALSE(Summarize(Open(), false).is_of_population);  // a condition's own numbers
}

// Of all trials together, the trials of a draw as one cluster.
TEST_F(PopulationSummary, RankingsOfErrorsHaveTheIntervalOverDraws) {
  std::vector<StatedError> errors;
  Open().ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
    errors.push_back({records[0].density.rotation_sd_deg, records[0].rotation_error_deg,
                      static_cast<std::int64_t>(problem.condition / 2)});
  });
  const Sparsification expected = MeasureSparsification(errors);
  int num_checked = 0;
  for (const SummaryRow& row : Summarize(Open(), false, Pooling::kPooled).rows) {
    if (row.estimator != "standard" || row.quantity != "rotation_ause") continue;
    ++num_checked;
    EXPECT_EQ(row.n, 120);
    EXPECT_DOUBLE_EQ(row.value, expected.ause.value);
    EXPECT_NEAR(row.standard_error, expected.ause.standard_error, 1e-12);
    EXPECT_NEAR(row.interval.upper, expected.ause.interval.upper, 1e-12);
    EXPECT_EQ(expected.ause.num_clusters, 12);
  }
  EXPECT_EQ(num_checked, 1);
}

TEST_F(PopulationSummary, DifferencesHaveTheIntervalOverDraws) {
  CompareOptions options;
  options.pooling = Pooling::kPooled;
  options.compared = {"failure", "auc_10_deg", "max_error_median_deg"};
  const Comparison comparison = Compare(Open(), "", options);
  ASSERT_EQ(comparison.rows.size(), 3U);
  const PopulationDifference expected = MeasurePopulationDifference(pairs_, ConditionWeights::kByTrials);
  const ComparisonRow& failure = comparison.rows[0];
  EXPECT_TRUE(failure.is_of_population);
  EXPECT_NEAR(failure.difference, expected.value, 1e-12);
  EXPECT_DOUBLE_EQ(failure.interval.lower, expected.interval.lower);
  EXPECT_DOUBLE_EQ(failure.interval.upper, expected.interval.upper);
  for (const ComparisonRow& row : comparison.rows) {
    SCOPED_TRACE(row.event);
    EXPECT_EQ(row.n, 120);
    EXPECT_GE(row.holm_p_value, row.p_value);
    if (row.kind == ComparedKind::kError) continue;
    EXPECT_EQ(row.p_value < 0.05, !row.interval.Contains(0.0));
  }
}

TEST_F(PopulationSummary, ForecastsHaveClustersOfDraws) {
  const ForecastMeasures measures = MeasureFailureForecasts(Open()).front();
  ASSERT_TRUE(measures.is_of_population);
  EXPECT_EQ(measures.brier.num_clusters, 12);
  const PopulationRate expected = MeasurePopulationRate(counts_, ConditionWeights::kByTrials);
  EXPECT_DOUBLE_EQ(measures.failure.interval.upper, expected.interval.upper);
  EXPECT_LE(measures.interval_of_equal_width.lower, measures.error_of_equal_width.value);
  EXPECT_GE(measures.interval_of_equal_width.upper, measures.error_of_equal_width.value);
}

// Chosen draws are no sample.
TEST_F(PopulationSummary, ChosenDrawsHaveNone) {
  const StudyPlan plan = MakePlan(DrawnStudy("draws: [1, 2, 3], "));
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("chosen.sqlite"), plan);
    RunStudy(plan, 2, &store);
  }
  const ResultStore store = ResultStore::OpenForReading(folder_.Path("chosen.sqlite"));
  EXPECT_FALSE(Summarize(store, false, Pooling::kPooled).is_of_population);
}

// Of kept counts the same numbers, also where trials were not simulated: no baseline gives a parallax of 119
// deg.
TEST(PopulationSummaryOfCounts, IsThatOfTheTrials) {
  const Study study = ParseStudy(
      "trials: 4\nconditions: {number: 10, ranges: {scene: plane, motion: sideways, parallax_deg: {any: [2, "
      "119]}, "
      "sigma_px: {log: [0.2, 9]}, num_matches: 40}}\nestimators: [{name: standard}]\n",
      "study.yaml");
  const StudyPlan plan = MakePlan(study);
  const TempFolder folder;
  {
    ResultStore store = ResultStore::OpenForRun(folder.Path("trials.sqlite"), plan);
    RunStudy(plan, 2, &store);
  }
  CountStudy(plan, 2, folder.Path("counts.sqlite"), Shard{1, 1});
  Summary of_trials =
      Summarize(ResultStore::OpenForReading(folder.Path("trials.sqlite")), false, Pooling::kPooled);
  std::erase_if(of_trials.rows,  // a ranking needs the trials
                [](const SummaryRow& row) { return row.kind == SummaryRow::Kind::kArea; });
  const Summary of_counts =
      SummarizeCounts(OpenCounts(folder.Path("counts.sqlite")), false, Pooling::kPooled);
  EXPECT_EQ(SummaryAsCsv(of_trials), SummaryAsCsv(of_counts));
  const auto row = [&](const std::string& quantity) {
    return *std::ranges::find(of_trials.rows, SharedText(quantity), &SummaryRow::quantity);
  };
  EXPECT_EQ(row("not_simulated").n, 40);
  EXPECT_GT(row("not_simulated").value, 0.0);
  EXPECT_EQ(row("failure").n, std::llround(40 * (1.0 - row("not_simulated").value)));
  // A draw of 119 deg has no trial that counts, any other draw has all four.
  const std::int64_t num_impossible = std::ranges::count_if(plan.conditions, [](const Condition& condition) {
    return std::ranges::count(condition.levels, "119") > 0;
  });
  for (const Summary& summary : {of_trials, of_counts}) {
    EXPECT_EQ(summary.num_conditions_not_simulated, num_impossible);
    EXPECT_EQ(summary.num_conditions_with_trials, 10);
    const std::string text = SummaryAsTable(summary);
    EXPECT_NE(text.find(fmt::format("{} of 10 conditions have no trial that counts", num_impossible)),
              std::string::npos)
        << text;
  }
}

}  // namespace
}  // namespace rcme
