#include "experiments/run/run_until.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "experiments/run/store/merge_results.h"
#include "experiments/statistics/summarize.h"
#include "stats/confidence_sequence.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// No outliers, where hardly anything is refused, and 40 % of them, where most is.
Study EasyAndHard() {
  Study study = SmallStudy();
  study.factors[0].levels = {"0", "0.4"};
  return study;
}

class RunUntilTest : public testing::Test {
 protected:
  std::vector<CellPrecision> Run(const std::string& name, const UntilOptions& options) {
    ResultStore store = ResultStore::OpenForRun(folder_.Path(name), plan_);
    return RunUntil(plan_, options, &store);
  }
  std::string ReadRecordTexts(const std::string& name) {
    std::string text;
    ResultStore::OpenForReading(folder_.Path(name)).ForEachRecord([&](const TrialRecord& record) {
      text += RecordText(record) + "\n";
    });
    return text;
  }
  static UntilOptions Until(const std::string& target, std::int64_t max_trials = 1'000'000,
                            int num_threads = 0) {
    UntilOptions options;
    options.target = PrecisionTarget::Parse(target);
    options.event = *std::ranges::find(TrialEvents(), "refusal", &TrialEvent::name);
    options.max_trials = max_trials;
    options.num_threads = num_threads;
    return options;
  }

  TempFolder folder_;
  StudyPlan plan_ = MakePlan(EasyAndHard());
};

TEST_F(RunUntilTest, AddsTrialsWhereTheyAreNeeded) {
  const std::vector<CellPrecision> cells = Run("run", Until("ci=0.06"));
  ASSERT_EQ(cells.size(), 2u);
  for (const CellPrecision& cell : cells) {
    EXPECT_TRUE(cell.is_reached);
    EXPECT_LE(0.5 * (cell.interval.upper - cell.interval.lower), 0.06);
    EXPECT_TRUE(cell.interval.Contains(cell.rate));
  }
  EXPECT_EQ(cells[0].num_trials, 100);  // hardly a refusal: the first look is enough
  // +-0.06 of a rate of 0.7 takes more; each look is at half as many trials more than the one before.
  EXPECT_THAT(cells[1].num_trials, testing::AnyOf(225, 337, 505, 757));
  const Summary summary = Summarize(ResultStore::OpenForReading(folder_.Path("run")), false);
  for (const SummaryRow& row : summary.rows) {
    if (row.kind != SummaryRow::Kind::kRate) continue;
    EXPECT_EQ(row.interval_kind, IntervalKind::kAnytimeValid);
  }
}

TEST_F(RunUntilTest, TheSameTrialsWhateverTheThreadsAndHoweverOftenItWasCutOff) {
  const std::vector<CellPrecision> whole = Run("whole", Until("ci=0.08", 1'000'000, 1));
  Run("parts", Until("ci=0.3", 1'000'000, 3));  // a coarser target first: fewer trials of the same sequence
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("parts"), plan_);
    for (const std::uint32_t trial : {101u, 130u}) {  // as if killed within a round
      const TrialResult result = RunTrial(plan_, plan_.conditions[1], trial);
      if (store.ReadTrialRecords(1, trial).empty()) store.Add({result.problem}, result.records);
    }
  }
  const std::vector<CellPrecision> parts = Run("parts", Until("ci=0.08", 1'000'000, 2));
  for (size_t c = 0; c < whole.size(); ++c) {
    EXPECT_EQ(whole[c].num_trials, parts[c].num_trials);
    EXPECT_EQ(whole[c].rate, parts[c].rate);
  }
  EXPECT_EQ(ReadRecordTexts("whole"), ReadRecordTexts("parts"));
}

// Two shards in rounds, one of which is lost once: the trials of one run, and so its tables.
TEST_F(RunUntilTest, ShardsInRoundsRunTheTrialsOfOneRun) {
  const UntilOptions options = Until("ci=0.06", 1'000'000, 1);
  const std::vector<CellPrecision> whole = Run("whole", options);
  std::string merged;
  int num_rounds = 0;
  for (bool is_open = true; is_open; ++num_rounds) {
    ASSERT_LT(num_rounds, 12);
    std::optional<ResultStore> before;
    if (!merged.empty()) before.emplace(ResultStore::OpenForReading(merged));
    std::vector<std::string> parts;
    for (const std::uint32_t number : {1u, 2u}) {
      parts.push_back(folder_.Path(fmt::format("part_{}", number)));
      if (num_rounds == 2 && number == 2) {
        std::filesystem::remove(parts[1]);  // its trials of all rounds
        continue;
      }
      ResultStore store = ResultStore::OpenForRun(parts[number - 1], plan_, {number, 2});
      is_open = RunRoundUntil(plan_, options, {number, 2}, before ? &*before : nullptr, &store);
    }
    if (num_rounds == 2) parts.pop_back();
    merged = folder_.Path(fmt::format("merged_{}", num_rounds));
    EXPECT_EQ(MergeResults(parts, merged, false, {}).num_missing, 0)
        << "how many there are to be is not known";
  }
  EXPECT_GT(num_rounds, 3);
  EXPECT_EQ(ReadRecordTexts("whole"), ReadRecordTexts(std::filesystem::path(merged).filename()));
  ResultStore store = ResultStore::OpenForRun(merged, plan_);
  const std::int64_t num_before = store.NumTrials();
  const std::vector<CellPrecision> cells = RunUntil(plan_, options, &store);
  EXPECT_EQ(store.NumTrials(), num_before);
  for (size_t c = 0; c < whole.size(); ++c) {
    EXPECT_EQ(cells[c].num_trials, whole[c].num_trials);
    EXPECT_EQ(cells[c].rate, whole[c].rate);
  }
}

// A run that was killed has the trial after the last one of the first look, a refusal: it is not counted
// among the 100.
TEST_F(RunUntilTest, TheTrialAfterTheLastOneIsNotCounted) {
  {
    ResultStore store = ResultStore::OpenForRun(folder_.Path("run"), plan_);
    TrialResult result = RunTrial(plan_, plan_.conditions[0], 100);
    for (TrialRecord& record : result.records) record.status = MotionStatus::kNoCandidate;
    store.Add({result.problem}, result.records);
  }
  const std::vector<CellPrecision> cells = Run("run", Until("ci=0.06", 100)),
                                   clean = Run("clean", Until("ci=0.06", 100));
  EXPECT_EQ(cells[0].num_trials, 100);
  EXPECT_EQ(cells[0].rate, clean[0].rate);
  EXPECT_EQ(cells[0].interval.upper, clean[0].interval.upper);
}

TEST_F(RunUntilTest, ARelativeTargetWhereNothingHappensEndsAtTheLimitAndSaysSo) {
  const std::vector<CellPrecision> cells = Run("run", Until("rel=0.3", 400));
  EXPECT_FALSE(cells[0].is_reached);
  EXPECT_EQ(cells[0].num_trials, 400);
  EXPECT_TRUE(cells[1].is_reached);
  EXPECT_LE(0.5 * (cells[1].interval.upper - cells[1].interval.lower), 0.3 * cells[1].rate);
}

// One refuses always, which is soon known: the other one decides.
TEST_F(RunUntilTest, TheEstimatorWithTheWidestIntervalDecides) {
  Study study = EasyAndHard();
  study.estimators[0] = study.estimators[1];
  study.estimators[0].label = "refuses";
  SetOptions(&study.estimators[0], {{"mu", "-50"}});
  plan_ = MakePlan(study);
  const std::vector<CellPrecision> cells = Run("run", Until("ci=0.08"));
  EXPECT_EQ(cells[1].estimator, 1u);
  EXPECT_GT(cells[1].num_trials, 100);
}

TEST_F(RunUntilTest, WeightedTrialsAreRefused) {
  Study study = EasyAndHard();
  study.data.emplace_back("outlier_count", "bernoulli");
  study.data.emplace_back("tilted_to", "0.9");
  plan_ = MakePlan(study);
  EXPECT_TRUE(ThrowsInputError([&] { Run("run", Until("ci=0.1")); }, {"--until", "tilted_to"}));
}

TEST(PrecisionTarget, ReadsWhatItShouldAndNothingElse) {
  EXPECT_EQ(PrecisionTarget::Parse("ci=0.002").value, 0.002);
  EXPECT_EQ(PrecisionTarget::Parse("rel=0.1").kind, PrecisionTarget::Kind::kRelative);
  for (const char* bad : {"", "ci", "ci=", "ci=0", "ci=-1", "ci=nan", "ci=inf", "ci=2", "ci=1e-9",
                          "width=0.1", "=", "rel=0.1x", "ci=0.1=0.2"}) {
    EXPECT_TRUE(ThrowsInputError([&] { PrecisionTarget::Parse(bad); }, {"--until", "ci=", "rel="})) << bad;
  }
}

}  // namespace
}  // namespace rcme
