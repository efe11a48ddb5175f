#include "experiments/statistics/run_counts.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "experiments/core/work/stop_request.h"
#include "experiments/run/run_study.h"
#include "experiments/statistics/count_study.h"
#include "experiments/statistics/merge_counts.h"
#include "experiments/statistics/summarize_counts.h"
#include "experiments/statistics/summary_output.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/shard_files.h"

namespace rcme {
namespace {

class RunCountsTest : public ShardFiles {
 protected:
  RunCountsTest() : ShardFiles(40) {}

  void RunShard(const StudyPlan& plan, const Shard& shard, const std::string& path) const override {
    CountStudy(plan, 1, path, shard);
  }
  MergeReport MergeFiles(const Paths& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options) const override {
    return MergeCounts(parts, out, is_partial, options);
  }
  std::string RunTrials() {
    const StudyPlan plan = MakePlan(study_);
    ResultStore store = ResultStore::OpenForRun(folder_.Path("trials.sqlite"), plan);
    RunStudy(plan, 1, &store);
    return folder_.Path("trials.sqlite");
  }
  static std::string Bytes(const std::string& path) {
    const RunCounts counts = OpenCounts(path);
    std::string text = SummaryAsJson(SummarizeCounts(counts, false)) +
                       SummaryAsCsv(SummarizeCounts(counts, false, Pooling::kPooled));
    for (const ConditionCounts& condition : counts.conditions) {
      for (const auto& [number, trial] : condition.kept.All())
        for (const TrialRecord& record : trial.records) text += RecordText(record) + "\n";
    }
    return text;
  }
};

// Equal to the last bit but for what the sums of trials round.
TEST_F(RunCountsTest, SumUpToWhatTheTrialsDo) {
  const std::string counts = Run({1, 1}), trials = RunTrials();
  for (const Pooling pooling : {Pooling::kPerCondition, Pooling::kPooled}) {
    const Summary of_counts = SummarizeCounts(OpenCounts(counts), false, pooling);
    Summary of_trials = Summarize(ResultStore::OpenForReading(trials), false, pooling);
    const size_t num_areas = std::erase_if(of_trials.rows, [](const SummaryRow& row) {
      return row.kind == SummaryRow::Kind::kArea;  // a ranking needs the trials
    });
    EXPECT_GT(num_areas, 0u);
    EXPECT_EQ(of_counts.num_trials_done, of_trials.num_trials_done);
    EXPECT_EQ(of_counts.num_trials_planned, of_trials.num_trials_planned);
    EXPECT_EQ(of_counts.levels, of_trials.levels);
    ASSERT_EQ(of_counts.rows.size(), of_trials.rows.size());
    std::set<SummaryRow::Kind> kinds;
    for (size_t i = 0; i < of_counts.rows.size(); ++i) {
      const SummaryRow &a = of_counts.rows[i], &b = of_trials.rows[i];
      SCOPED_TRACE(a.estimator.text() + " " + a.quantity.text());
      kinds.insert(a.kind);
      EXPECT_EQ(a.quantity, b.quantity);
      EXPECT_EQ(a.condition, b.condition);
      EXPECT_EQ(a.n, b.n);
      const auto near = [](double x, double y, double tolerance) {
        return (std::isnan(x) && std::isnan(y)) || x == y || std::abs(x - y) <= tolerance * std::abs(y);
      };
      const bool is_exact = a.kind == SummaryRow::Kind::kRate || a.kind == SummaryRow::Kind::kMedian;
      EXPECT_TRUE(near(a.value, b.value, is_exact ? 0.0 : 1e-12)) << a.value << " " << b.value;
      EXPECT_TRUE(near(a.standard_error, b.standard_error, 1e-10))
          << a.standard_error << " " << b.standard_error;
      EXPECT_TRUE(near(a.interval.lower, b.interval.lower, is_exact ? 0.0 : 1e-7)) << a.interval.lower;
      EXPECT_TRUE(near(a.interval.upper, b.interval.upper, is_exact ? 0.0 : 1e-7)) << a.interval.upper;
    }
    EXPECT_GE(kinds.size(), 4u);
  }
}

TEST_F(RunCountsTest, AnyShardsInAnyOrderAndGroupsGiveTheSameBytes) {
  const std::string whole = Bytes(Run({1, 1}));
  for (const std::uint32_t count : {2u, 7u, 50u}) {
    Paths parts = RunAll(count);
    EXPECT_EQ(Bytes(Merge(parts)), whole) << count;
    EXPECT_EQ(last_.num_trials, 80);
    std::ranges::reverse(parts);
    const auto half = parts.begin() + static_cast<std::ptrdiff_t>(count / 2);
    const Paths groups = {Merge({half, parts.end()}, true), Merge({parts.begin(), half}, true)};
    const std::string merged = Merge(groups);
    EXPECT_EQ(Bytes(merged), whole) << count;
    study_.trials = 50;  // a merged run goes on as any run
    CountStudy(MakePlan(study_), 1, merged);
    EXPECT_EQ(OpenCounts(merged).NumTrials(), 100);
    study_.trials = 40;
  }
}

TEST_F(RunCountsTest, NamesWhatIsMissingAndRefusesWhatIsThereTwice) {
  const Paths parts = RunAll(4);
  const MergeReport report = CheckCounts({parts[0], parts[3]}, {});
  EXPECT_EQ(report.missing_shards, (std::vector<std::uint32_t>{2, 3}));
  EXPECT_EQ(report.num_missing, 40);
  EXPECT_FALSE(std::filesystem::exists(Merge({parts[0]})));
  const std::string whole = Merge(parts);
  Paths again = parts;
  again.push_back(Run({2, 4}, "again"));  // other times, the same numbers
  EXPECT_EQ(Bytes(Merge(again)), Bytes(whole));
  EXPECT_EQ(last_.num_twice, 20);
  study_.trials = 60;
  again.back() = Run({2, 4}, "longer");
  EXPECT_TRUE(ThrowsInputError([&] { Merge(again); }, {"longer_2_4", "an earlier part counts"}));
  study_.trials = 40;
  EXPECT_TRUE(ThrowsInputError([&] { Merge({parts[0], Run({2, 3})}); }, {"different numbers of shards"}));
  EXPECT_TRUE(ThrowsInputError([&] { Merge({parts[0], RunTrials()}); }, {"keeps"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { MergeResults({parts[0]}, folder_.Path("no"), false, {}); }, {"holds counts"}));
}

TEST_F(RunCountsTest, GoOnWhereTheyWereStopped) {
  const StudyPlan plan = MakePlan(study_);
  const std::string path = folder_.Path("stopped.sqlite");
  {
    const StopOnSignals stop;
    StopAfter(std::chrono::milliseconds(1));
    EXPECT_THROW(CountStudy(plan, 1, path), Stopped);
  }
  const std::int64_t num_kept = OpenCounts(path).NumTrials();
  EXPECT_LT(num_kept, 80);
  const RunReport report = CountStudy(plan, 1, path);
  EXPECT_EQ(report.num_run_now, 80 - num_kept);
  EXPECT_EQ(Bytes(path), Bytes(Run({1, 1})));
  EXPECT_EQ(CountStudy(plan, 1, path).num_run_now, 0);
}

TEST_F(RunCountsTest, DamageIsNoticed) {
  for (const std::string& sql :
       {std::string("UPDATE counts SET n = n - 1 WHERE quantity = 'success' AND estimator = 1"),
        std::string("UPDATE counts SET sum = '0' WHERE quantity = 'failure'"),
        std::string("DELETE FROM counts WHERE quantity = 'nees' AND condition = 1"),
        std::string("UPDATE counted SET places = '0-38'"),
        std::string("DELETE FROM counted WHERE condition = 0"),
        std::string("DELETE FROM problems WHERE condition = 0")}) {
    const std::string path = Run({1, 1}, "damaged");
    Change(path, sql);
    EXPECT_TRUE(ThrowsInputError([&] { OpenCounts(path); }, {path, "is damaged"})) << sql;
    std::filesystem::remove(path);
  }
}

TEST_F(RunCountsTest, KeepsASampleAndFailuresOfEveryCondition) {
  study_.trials = 300;
  const RunCounts counts = OpenCounts(Run({1, 1}));
  for (const ConditionCounts& condition : counts.conditions) {
    const auto kept = condition.kept.All();
    EXPECT_GE(kept.size(), KeptTrials::kNumSampled);
    EXPECT_LE(kept.size(), KeptTrials::kNumSampled + KeptTrials::kNumFailed);
    std::set<std::uint32_t> early;
    for (const auto& [number, trial] : kept) early.insert(number < 150);
    EXPECT_EQ(early.size(), 2u) << "the sample is not of all trials";
  }
}

TEST_F(RunCountsTest, RefusesWhatCannotBeCounted) {
  const std::string counts = Run({1, 1});
  const StudyPlan plan = MakePlan(study_);
  EXPECT_TRUE(
      ThrowsInputError([&] { ResultStore::OpenForRun(counts, plan); }, {"counts of the whole study"}));
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForReading(counts); }, {"holds counts, not trials"}));
  EXPECT_TRUE(ThrowsInputError([&] { CountStudy(plan, 1, RunTrials()); }, {"trials of the whole study"}));
  EXPECT_FALSE(KeepsCounts(RunTrials()));
  EXPECT_TRUE(KeepsCounts(counts));
  study_.repeats_per_scene = 2;
  EXPECT_TRUE(ThrowsInputError([&] { Run({1, 1}, "repeats"); }, {"repeats_per_scene"}));
  study_.repeats_per_scene = 1;
  study_.data.emplace_back("outlier_count", "bernoulli");
  study_.data.emplace_back("tilted_to", "0.9");
  EXPECT_TRUE(ThrowsInputError([&] { Run({1, 1}, "weights"); }, {"tilted_to"}));
}

}  // namespace
}  // namespace rcme
