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

}  // namespace
}  // namespace rcme
