#include "experiments/run/store/merge_results.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "experiments/run/run_study.h"
#include "experiments/run/store/distinct_trials.h"
#include "experiments/run/store/new_trials.h"
#include "experiments/statistics/summarize.h"
#include "experiments/statistics/summary_output.h"
#include "experiments/statistics/trial_table.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/shard_files.h"

namespace rcme {
namespace {

class MergeTest : public ShardFiles {
 protected:
  MergeTest() : ShardFiles(11) {}

  void RunShard(const StudyPlan& plan, const Shard& shard, const std::string& path) const override {
    ResultStore store = ResultStore::OpenForRun(path, plan, shard);
    RunStudy(plan, 1, &store, shard);
  }
  MergeReport MergeFiles(const Paths& parts, const std::string& out, bool is_partial,
                         const MergeOptions& options) const override {
    return MergeResults(parts, out, is_partial, options);
  }
  // All that is said of a run: its summary and its trials, the times aside.
  static std::string Bytes(const std::string& path) {
    const ResultStore store = ResultStore::OpenForReading(path);
    std::string text = SummaryAsCsv(Summarize(store, false)) + SummaryAsJson(Summarize(store, false));
    WriteTrialTable(store, false, [&](const std::string& rows) { text += rows; });
    return text;
  }
  // A file of another origin: as if another program had computed it.
  void Rename(const std::string& path, const TrialOrigin& origin) {
    ResultStore store = ResultStore::OpenForRun(path, MakePlan(study_));
    store.NoteOrigin(origin);
  }
  testing::AssertionResult Refuses(const Paths& parts, const std::vector<std::string>& fragments) {
    const auto before = folder_.NumEntries();
    const auto result = ThrowsInputError([&] { Merge(parts); }, fragments);
    EXPECT_EQ(folder_.NumEntries(), before) << "a refusal leaves a file";
    return result;
  }
};

// Files taken together must not count a trial twice: shards do not, a shard beside the whole does.
TEST_F(MergeTest, FilesThatHoldATrialBothAreTold) {
  const Paths parts = RunAll(3);
  EXPECT_NO_THROW(RequireDistinctTrials(parts));
  const std::string whole = Merge(parts);
  for (const Paths& paths :
       {Paths{whole, whole}, Paths{parts[0], whole}, Paths{parts[0], parts[1], parts[0]}})
    EXPECT_TRUE(ThrowsInputError([&] { RequireDistinctTrials(paths); }, {paths.back(), "count twice"}));
  // A copy of the study by another name has the same trials, one with another seed has not.
  study_.name = "renamed";
  const std::string renamed = folder_.Path("renamed.sqlite"), other = folder_.Path("other.sqlite");
  RunShard(MakePlan(study_), {}, renamed);
  EXPECT_TRUE(ThrowsInputError([&] { RequireDistinctTrials(Paths{whole, renamed}); }, {"count twice"}));
  ++study_.seed;
  RunShard(MakePlan(study_), {}, other);
  EXPECT_NO_THROW(RequireDistinctTrials(Paths{whole, other}));
}

TEST_F(MergeTest, AnyNumberOrderAndGroupingGivesTheBytesOfOneRun) {
  const std::string whole = Bytes(Run({1, 1}));
  EXPECT_GT(whole.size(), 10'000u);
  for (const std::uint32_t count : {1u, 2u, 7u, 30u}) {  // 30: more than trials of a condition
    Paths parts = RunAll(count);
    EXPECT_EQ(Bytes(Merge(parts)), whole) << count;
    EXPECT_EQ(last_.num_trials, 22);
    EXPECT_EQ(last_.num_twice, 0);
    std::ranges::reverse(parts);
    EXPECT_EQ(Bytes(Merge(parts)), whole) << count;
    std::ranges::rotate(parts, parts.begin() + static_cast<std::ptrdiff_t>(count / 3));
    const auto half = parts.begin() + static_cast<std::ptrdiff_t>(count / 2);
    Paths groups = {Merge({half, parts.end()}, true)};
    if (half != parts.begin()) groups.insert(groups.begin(), Merge({parts.begin(), half}, true));
    const std::string merged = Merge(groups);
    EXPECT_EQ(Bytes(merged), whole) << count;
    EXPECT_EQ(ResultStore::OpenForReading(merged).Description().shard, "");
  }
}

TEST_F(MergeTest, ScenesOfRepeatsStayTogether) {
  study_.repeats_per_scene = 3;
  const std::string whole = Bytes(Run({1, 1}));
  EXPECT_EQ(Bytes(Merge(RunAll(3))), whole);
}

TEST_F(MergeTest, OtherNumbersOfShardsAndMoreTrialsFitTogether) {
  Paths parts = RunAll(2);
  parts.push_back(Run({2, 3}));
  parts.push_back(parts[0]);
  EXPECT_EQ(Bytes(Merge(parts)), Bytes(Run({1, 1})));
  EXPECT_GT(last_.num_twice, 11);
  study_.trials = 20;  // one shard is extended, and takes the others with it
  Run({1, 2});
  parts = {folder_.Path("part_1_2.sqlite"), folder_.Path("part_2_2.sqlite")};
  EXPECT_EQ(CheckParts(parts, {}).missing_shards, (std::vector<std::uint32_t>{2}));
  Run({2, 2});
  EXPECT_EQ(Bytes(Merge(parts)), Bytes(Run({1, 1})));
}

TEST_F(MergeTest, NamesTheShardsThatAreMissing) {
  const Paths parts = RunAll(7);
  const Paths some = {parts[0], parts[1], parts[3], parts[6]};
  const MergeReport report = CheckParts(some, {});
  EXPECT_EQ(report.num_shards, 7u);
  EXPECT_EQ(report.missing_shards, (std::vector<std::uint32_t>{3, 5, 6}));
  EXPECT_EQ(report.num_trials + report.num_missing, 22);
  EXPECT_GT(report.num_missing, 0);
  EXPECT_EQ(CheckParts(parts, {}).num_missing, 0);

  const std::string none = Merge(some);
  EXPECT_FALSE(std::filesystem::exists(none)) << "a file that lacks trials was written";
  const std::string partial = Merge(some, true);
  EXPECT_EQ(ResultStore::OpenForReading(partial).Description().shard, "1-2,4,7/7");
  EXPECT_EQ(CheckParts({partial, parts[4]}, {}).missing_shards, (std::vector<std::uint32_t>{3, 6}));
  const Paths mixed = {parts[0], Run({1, 2})};
  EXPECT_EQ(CheckParts(mixed, {}).num_shards, 0u) << "who has the missing trials is not known";
  EXPECT_GT(CheckParts(mixed, {}).num_missing, 0);
}

TEST_F(MergeTest, ACheckGoesOnPastWhatCannotBeRead) {
  Paths parts = RunAll(3);
  Change(parts[1],
         "UPDATE trials SET num_inliers = num_inliers + 1 WHERE trial = (SELECT max(trial) FROM trials)");
  EXPECT_TRUE(Refuses(parts, {parts[1], "is damaged"}));
  const MergeReport report = CheckParts(parts, {});
  EXPECT_EQ(report.missing_shards, (std::vector<std::uint32_t>{2}));
  ASSERT_EQ(report.unreadable.size(), 1u);
  folder_.Write("part_1_3.sqlite", "");
  EXPECT_EQ(CheckParts(parts, {}).missing_shards, (std::vector<std::uint32_t>{1, 2}));
  folder_.Write("part_3_3.sqlite", "nonsense");
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        CheckParts({parts[0], parts[2]}, {});
      },
      {"no part can be read", parts[2]}));
  EXPECT_TRUE(Refuses({folder_.Path("nothing.sqlite")}, {"no such result file"}));
}

TEST_F(MergeTest, RefusesWhatDoesNotBelongTogether) {
  const Paths parts = RunAll(2);
  study_.seed = 4;
  EXPECT_TRUE(Refuses({parts[0], Run({2, 2}, "seed")}, {"another study", "'seed: 3' there, 'seed: 4' here"}));
  study_ = SmallStudy();
  study_.trials = 11;
  Override(&study_, "num_iterations", "21");
  EXPECT_TRUE(Refuses({parts[0], Run({2, 2}, "option")}, {"another study", "21"}));
  study_ = SmallStudy();
  study_.trials = 11;
  const std::string until = Run({1, 1}, "until");
  { ResultStore::OpenForRun(until, MakePlan(study_)).NoteStoppingRule("a rule"); }
  EXPECT_TRUE(Refuses({parts[0], until}, {"another rule", "a rule"}));
  const std::string out = Merge(parts);
  EXPECT_TRUE(ThrowsInputError([&] { MergeResults(parts, out, false, {}); }, {"exists already"}));
}

// A part of somebody's with the identity of the others, whose checksums are right.
TEST_F(MergeTest, RefusesAPartWithOtherConditions) {
  const std::string part = Run({1, 2}), forged = folder_.Path("forged.sqlite");
  RunDescription run = ResultStore::OpenForReading(part).Description();
  run.conditions.pop_back();
  NewTrials(forged, run).Finish(run);
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Merge({part, forged});
      },
      {forged, "is damaged: it has 1 conditions", part, "has 2", "rcme check"}));
  EXPECT_THROW(Merge({forged, part}), DamagedFileError);
}

TEST_F(MergeTest, RefusesOtherProgramsAndUnlessAllowedOtherInstructionSets) {
  const std::string whole = Run({1, 1}), other = Run({1, 1}, "program");
  Rename(other, {"abacus 2", ThisProgram().instruction_set});
  EXPECT_TRUE(Refuses({whole, other}, {"program", "abacus 2", ThisProgram().program}));
  const std::string bits = Run({1, 1}, "bits");
  Rename(bits, {ThisProgram().program, "beads"});
  EXPECT_TRUE(Refuses({whole, bits}, {"instruction set", "beads"}));
  const std::string merged = Merge({bits, whole}, false, {.are_instruction_sets_mixed = true});
  EXPECT_EQ(Bytes(merged), Bytes(whole));
  EXPECT_NE(ResultStore::OpenForReading(merged).Description().origin.instruction_set.find("beads"),
            std::string::npos);
}

TEST_F(MergeTest, ATrialThatIsThereTwiceHasToBeTheSame) {
  const std::string whole = Run({1, 1}), forged = folder_.Path("forged.sqlite");
  {
    const ResultStore store = ResultStore::OpenForReading(whole);
    NewTrials copy(forged, store.Description());
    store.ForEachTrial([&](const ProblemRecord& problem, const std::vector<TrialRecord>& records) {
      std::vector<TrialRecord> changed = records;
      changed[0].seconds *= 2.0;  // which no two runs share
      if (problem.condition == 1 && problem.trial == 7) ++changed[1].num_explained;
      copy.Add({problem, changed, 0});
    });
    copy.Finish(store.Description());
  }
  EXPECT_TRUE(Refuses({whole, forged}, {forged, "condition 1, trial 7", "num_explained"}));
  EXPECT_EQ(Bytes(Merge({Run({1, 2}), whole})), Bytes(whole));
}

TEST_F(MergeTest, AShardIsNotContinuedAsAnother) {
  const std::string part = Run({1, 2});
  const StudyPlan plan = MakePlan(study_);
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        ResultStore::OpenForRun(part, plan, {2, 2});
      },
      {"shard 1/2", "shard 2/2"}));
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForRun(part, plan); }, {"shard 1/2", "whole study"}));
  const std::string whole = Run({1, 1});
  EXPECT_TRUE(ThrowsInputError([&] { ResultStore::OpenForRun(whole, plan, {2, 2}); }, {"whole study"}));
}

}  // namespace
}  // namespace rcme
