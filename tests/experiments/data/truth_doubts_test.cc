#include "experiments/data/truth_doubts.h"

#include <gtest/gtest.h>

#include "experiments/statistics/truth_quality.h"
#include "experiments/study/run_description.h"
#include "experiments/study/study_file.h"
#include "experiments/study/study_plan.h"
#include "experiments/trial/trial.h"
#include "experiments/trial/trial_event.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

TEST(TruthDoubts, AreReadByTheirColumns) {
  const TempFolder folder;
  TruthDoubts doubts(folder.Write("list.csv", "p_value,pair_id,scene\n1e-9,a_001,a\n,b 2,\"b,c\"\n"));
  EXPECT_TRUE(doubts.Has("a", "a_001"));
  EXPECT_TRUE(doubts.Has("b,c", "b 2"));
  EXPECT_FALSE(doubts.Has("b", "a_001"));
  EXPECT_FALSE(TruthDoubts("").Has("a", "a_001"));
}

TEST(TruthDoubts, WhatIsWrongIsSaid) {
  const TempFolder folder;
  const auto refuses = [&](const std::string& text, const std::vector<std::string>& words) {
    const std::string path = folder.Write("list.csv", text);
    return ThrowsInputError([&] { TruthDoubts doubts(path); }, words);
  };
  EXPECT_TRUE(refuses("", {"list.csv", "scene", "pair_id"}));
  EXPECT_TRUE(refuses("scene,name\na,b\n", {"list.csv", "pair_id"}));
  EXPECT_TRUE(refuses("reason,scene,pair_id\nwrong\n", {"list.csv:2", "pair_id"}));
  EXPECT_TRUE(ThrowsInputError([&] { TruthDoubts doubts(folder.Path("none.csv")); }, {"none.csv"}));
}

// A folder of three pairs, of which a list names one.
class StudyWithDoubts : public testing::Test {
 protected:
  StudyWithDoubts() {
    for (const char* name : {"a_000.csv", "a_001.csv", "a_002.csv"})
      pairs_.Write(name, "# scene: a\n" + TruePoseHeader() + MatchHeader() + MatchRows(40));
  }
  StudyPlan Plan(const std::string& list) {
    std::string data = "scene: match_files, folder: '" + pairs_.path() + "'";
    if (!list.empty()) data += ", truth_in_doubt: '" + other_.Write("doubts.csv", list) + "'";
    return MakePlan(
        ParseStudy("data: {" + data + "}\nestimators: [{name: standard}]\ntrials: 1\n", "t.yaml"));
  }

  TempFolder pairs_, other_;
};

TEST_F(StudyWithDoubts, ItsPairsAreRunAndNotScored) {
  const StudyPlan plan = Plan("scene,pair_id\na,a_001\n");
  for (const std::uint32_t trial : {0u, 1u, 2u}) {
    const TrialResult result = RunTrial(plan, plan.conditions[0], trial);
    const TrialRecord& record = result.records[0];
    EXPECT_EQ(result.estimates[0].status, MotionStatus::kOk);  // the estimator is asked all the same
    EXPECT_EQ(IsCounted(record), trial != 1);
    EXPECT_EQ(IsScored(record), trial != 1);
    EXPECT_EQ(HasSucceeded(record, {}), trial != 1);
    EXPECT_FALSE(HasFailed(record, {}) || HasRefused(record));
    EXPECT_EQ(OutcomeInFull(record, {}), trial == 1 ? "truth_in_doubt" : "success");
    EXPECT_EQ(std::isnan(record.rotation_error_deg), trial == 1);
  }
}

// Which pairs are listed is part of what the study is, where the list lies is not; without the key nothing
// of it is to be seen.
TEST_F(StudyWithDoubts, TheirNumberIsSaidAndCounts) {
  const std::string without = Describe(Plan("")).identity, none = Describe(Plan("scene,pair_id\n")).identity,
                    one = Describe(Plan("scene,pair_id\na,a_001\n")).identity,
                    another = Describe(Plan("scene,pair_id\na,a_002\nother,x\n")).identity;
  EXPECT_EQ(without, none);
  EXPECT_EQ(without.find("doubt"), std::string::npos);
  EXPECT_NE(one, without);
  EXPECT_NE(one, another);
  EXPECT_NE(DescribeTruthQuality(one).find("The truth of 1 of 3 pairs is in doubt"), std::string::npos);
  EXPECT_EQ(DescribeTruthQuality(without).find("doubt"), std::string::npos);
}

TEST_F(StudyWithDoubts, TheListMayBeGivenByTheCommand) {
  const std::string list = other_.Write("doubts.csv", "scene,pair_id\na,a_001\n");
  Study study =
      ParseStudy("data: {scene: match_files, folder: nowhere}\nestimators: [{name: standard}]\n", "t");
  Override(&study, "folder", pairs_.path());
  Override(&study, "truth_in_doubt", list);
  EXPECT_TRUE(MakePlan(study).conditions[0].source->Make({1, 0, 1, 0}).truth.is_in_doubt);
  Study simulated = ParseStudy("data: {scene: plane}\nestimators: [{name: standard}]\n", "t");
  EXPECT_TRUE(ThrowsInputError([&] { Override(&simulated, "truth_in_doubt", list); },
                               {"truth_in_doubt", "needs scene: match_files"}));
}

TEST_F(StudyWithDoubts, AListOfOtherPairsIsRefused) {
  EXPECT_TRUE(ThrowsInputError([&] { Plan("scene,pair_id\nb,a_001\n"); }, {"doubts.csv", "1 pairs", "none"}));
}

}  // namespace
}  // namespace rcme
