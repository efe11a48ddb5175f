#include "experiments/real/truth_check/check_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "estimator/estimator_registry.h"
#include "experiments/core/table/render_table.h"
#include "experiments/data/truth_doubts.h"
#include "experiments/real/truth_check/truth_check_output.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

using testing::HasSubstr;

// The same pair without a rotation as if it had turned by 20 degrees.
const char* const kWrongTruth =
    "# R_rowmajor: 0.9396926207859084 0 0.3420201433256687 0 1 0 -0.3420201433256687 0 0.9396926207859084\n"
    "# t_unit: 0.8 0.6 0\n";

// Two front ends of three pairs: a right truth, a wrong one, and none.
class CheckTruthTest : public testing::Test {
 protected:
  CheckTruthTest() {
    std::uint64_t seed = 1;
    for (const TempFolder* folder : {&first_, &second_}) {
      folder->Write("a_000.csv", Text(TruePoseHeader(), ++seed));
      folder->Write("a_001.csv", Text(kWrongTruth, ++seed));
      folder->Write("a_002.csv", Text("", ++seed));
    }
  }
  static std::string Text(const std::string& truth, std::uint64_t seed) {
    return "# scene: a\n" + truth + MatchHeader() + MatchRows(300, seed);
  }
  std::vector<CheckedPair> Check(const std::vector<std::string>& folders) {
    return CheckTruths(folders, *MakeEstimator("rcme_calibrated"), {});
  }

  TempFolder first_, second_;
};

TEST_F(CheckTruthTest, FindsTheWrongOne) {
  const std::vector<CheckedPair> pairs = Check({first_.path(), second_.path()});
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_EQ(pairs[0].verdict.verdict, TruthVerdict::kHolds);
  EXPECT_EQ(pairs[1].verdict.verdict, TruthVerdict::kInDoubt);
  EXPECT_LE(pairs[1].verdict.p_value, 1e-4);
  ASSERT_EQ(pairs[1].front_ends.size(), 2u);
  EXPECT_NEAR(pairs[1].front_ends[0].rotation_error_deg, 20.0, 0.1);
  EXPECT_FALSE(pairs[2].has_truth);
  EXPECT_EQ(pairs[2].verdict.verdict, TruthVerdict::kSilent);
}

TEST_F(CheckTruthTest, IsWrittenForPeopleProgramsAndStudies) {
  const std::vector<CheckedPair> pairs = Check({first_.path()});
  const CommandResult result = MakeTruthCheckResult(pairs, {});
  const std::string &text = result.text, csv = RenderCsv(result.rows);
  EXPECT_THAT(text,
              HasSubstr("The truth of 1 of 3 pairs is in doubt; of 0 the matches say too little, and 1"));
  EXPECT_THAT(text, HasSubstr("a_001"));
  EXPECT_THAT(text, testing::Not(HasSubstr("a_000")));
  EXPECT_THAT(csv, testing::StartsWith("scene,pair_id,front_end,pair_verdict,verdict,matches,by_truth,"));
  const auto json = nlohmann::json::parse(result.json);
  EXPECT_EQ(json["format"], "rcme truth check 1");
  EXPECT_EQ(json["scenes"][0]["in_doubt"], 1);
  EXPECT_EQ(json["scenes"][0]["no_truth"], 1);
  EXPECT_EQ(json["evidence"][1]["pair_verdict"], "in_doubt");
  TruthDoubts doubts(first_.Write("list.txt", TruthDoubtsAsCsv(pairs)));
  EXPECT_TRUE(doubts.Has("a", "a_001"));
  EXPECT_FALSE(doubts.Has("a", "a_000"));
}

TEST_F(CheckTruthTest, FrontEndsOfOtherPairsAreRefused) {
  EXPECT_TRUE(ThrowsInputError([&] { Check({first_.path(), first_.path() + "/"}); }, {"twice"}));
  second_.Write("a_000.csv", Text(kWrongTruth, 9));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Check({first_.path(), second_.path()});
      },
      {"a_000.csv", "another true motion"}));
  second_.Write("a_000.csv", "# scene: b\n" + TruePoseHeader() + MatchHeader() + MatchRows(20));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        Check({first_.path(), second_.path()});
      },
      {"a_000.csv", "another scene"}));
}

// An INDEX.csv calls the direction weak: a wrong one alone is no reason to doubt.
TEST_F(CheckTruthTest, AWeakDirectionIsNotCompared) {
  const TempFolder folder;
  const std::string wrong_direction = "# R_rowmajor: 1 0 0 0 1 0 0 0 1\n# t_unit: 0 0 1\n";
  folder.Write("a_000.csv", Text(wrong_direction, 5));
  EXPECT_EQ(Check({folder.path()})[0].verdict.verdict, TruthVerdict::kInDoubt);
  folder.Write("INDEX.csv", "pair_id,t_gt_weak\na_000,1\n");
  EXPECT_EQ(Check({folder.path()})[0].verdict.verdict, TruthVerdict::kHolds);
}

}  // namespace
}  // namespace rcme
