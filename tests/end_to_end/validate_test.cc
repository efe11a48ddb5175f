// From pairs to what is said of their covariances without a truth.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/result_formats.h"

namespace rcme {
namespace {

class ValidateProgram : public testing::Test {
 protected:
  ProgramResult Call(const std::string& pairs, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"validate", pairs, "--out", out_, "--no-figure"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  std::string Written(const std::string& name) { return ReadBytes(out_ + "/" + name); }

  TempFolder folder_, pairs_;
  std::string study_ = folder_.Write("study.yaml", SmallStudyYaml());
  std::string out_ = folder_.Path("validation");
};

TEST_F(ValidateProgram, OfAFolderSaysOfEachSceneWhatItFound) {
  for (const char* name : {"a_1", "a_2", "b_1"}) {
    const std::string scene = std::string("# scene: ").append(1, name[0]) + "\n";
    pairs_.Write(std::string(name) + ".csv",
                 scene + MatchHeader() + MatchRows(80, static_cast<std::uint64_t>(name[2])));
  }
  const ProgramResult result = Call(pairs_.path(), {});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Written("validation.txt"));
  for (const char* part :
       {"a: 2 pairs, 2 answered, 0 loops", "b: 1 pairs", "spatial_halves", "closure", "no data"})
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in\n" << result.out;
  EXPECT_NE(Written("validation.csv").find("\na,2,2,spatial_halves,"), std::string::npos);
  EXPECT_NE(Written("validation.json").find("rcme validation 3"), std::string::npos);
  const std::string once = Written("validation.json");
  ASSERT_EQ(Call(pairs_.path(), {}).exit_code, 0);
  EXPECT_EQ(Written("validation.json"), once);
  ExpectFormatsAgree({"validate", pairs_.path(), "--twins", "1", "--no-advice"});
  ASSERT_EQ(Call(pairs_.path(), {"--seed", "2"}).exit_code, 0);
  EXPECT_NE(Written("validation.json"), once);
  const ProgramResult one = Call(pairs_.path(), {"--scene", "b", "--set", "covariance=robust"});
  EXPECT_EQ(one.out.find("a: 2 pairs"), std::string::npos) << one.out;
}

// The time is over before the first pair; other options are another validation.
TEST_F(ValidateProgram, GoesOnAfterATimeLimit) {
  const std::string kept = out_ + "/unfinished.part";
  const ProgramResult result = Call(study_, {"--trials", "3", "--max-time", "0.001s"});
  EXPECT_EQ(result.exit_code, 75) << result.err;
  EXPECT_NE(result.err.find(kept + " has 0 steps, the same command goes on"), std::string::npos)
      << result.err;
  EXPECT_TRUE(IsRefused(Call(study_, {"--trials", "3", "--seed", "2"}), {kept, "seed: 1", "--out"}));
  ASSERT_EQ(Call(study_, {"--trials", "3"}).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(kept));
}

TEST_F(ValidateProgram, OfAStudyTakesItsTrials) {
  const ProgramResult result = Call(study_, {"--trials", "3", "--data", "outlier_ratio=0.3"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("3 pairs"), std::string::npos) << result.out;
}

TEST_F(ValidateProgram, SaysWhatIsWrong) {
  pairs_.Write("a.csv", "# scene: a\n" + MatchHeader() + MatchRows(20));
  EXPECT_TRUE(IsRefused(Call(pairs_.path(), {"--scene", "b"}), {"--scene: there is no scene 'b'", "a"}));
  EXPECT_TRUE(IsRefused(Call(pairs_.path(), {"--trials", "3"}), {"PAIRS is a folder"}));
  EXPECT_TRUE(
      IsRefused(Call(study_, {"--data", "noise"}), {"--data: 'noise' is not allowed; give key=value"}));
  EXPECT_TRUE(IsRefused(Call(study_, {"--data", "nose=correlated"}), {"nose"}));
  EXPECT_TRUE(IsRefused(Call(folder_.Path("nothing"), {}), {"nothing"}));
  TempFolder empty;
  EXPECT_TRUE(IsRefused(Call(empty.path(), {}), {"holds no *.csv"}));
  pairs_.Write("b.csv", "# size1: 3\n");
  EXPECT_TRUE(IsRefused(Call(pairs_.path(), {}), {"b.csv"}));
}

// Closure by length is written where it is asked for, and nothing else changes.
TEST_F(ValidateProgram, MeasuresClosureByTheLengthOfLoops) {
  const std::vector<std::string> options = {"--images", "5", "--trials", "4", "--twins", "1", "--no-advice"};
  ASSERT_EQ(Call(study_, options).exit_code, 0);
  EXPECT_FALSE(std::filesystem::exists(out_ + "/closure.csv"));
  const std::string without = Written("validation.csv"), text = Written("validation.txt");
  std::vector<std::string> with_loops = options;
  with_loops.insert(with_loops.end(), {"--loops", "6"});
  const ProgramResult result = Call(study_, with_loops);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(Written("validation.csv"), without);
  EXPECT_EQ(result.out.find(text), 0u);
  const std::string csv = Written("closure.csv");
  EXPECT_EQ(csv.find("set,estimator,images,shared_errors,of,loops,apart,covered,covered_lower,covered_upper,"
                     "rms_over_sd,rms_over_sd_lower,rms_over_sd_upper\n"),
            0u)
      << csv;
  for (const char* row : {"rcme_calibrated,3,allowed for,pairs,", "rcme_calibrated,5,ignored,twins,"})
    EXPECT_NE(csv.find(row), std::string::npos) << row << "\n" << csv;
  EXPECT_EQ(csv.find("rcme_calibrated,6,"), std::string::npos) << csv;
  pairs_.Write("a.csv", "# scene: a\n" + MatchHeader() + MatchRows(20));
  EXPECT_TRUE(IsRefused(Call(pairs_.path(), {"--images", "3"}), {"--images", "PAIRS is a folder"}));
  EXPECT_TRUE(IsRefused(Call(study_, {"--images", "3", "--data", "noise=laplace"}), {"noise", "gaussian"}));
}

}  // namespace
}  // namespace rcme
