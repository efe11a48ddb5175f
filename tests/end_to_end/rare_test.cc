// From a study to rates of rare failures.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

class RareProgram : public testing::Test {
 protected:
  ProgramResult Call(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"rare", study_, "--out", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  std::string Written(const std::string& name) { return ReadBytes(out_ + "/" + name); }

  TempFolder folder_;
  std::string study_ = folder_.Write("study.yaml", SmallStudyYaml());
  std::string out_ = folder_.Path("rare");
  const std::vector<std::string> few_ = {
      "--particles", "20",    "--replicates",     "4",     "--moves",
      "1",           "--set", "severity=skipped", "--set", "max_direction_error_deg=2"};
};

TEST_F(RareProgram, WritesWhatItPrintsOnAnyNumberOfThreads) {
  std::vector<std::string> arguments = few_;
  arguments.insert(arguments.end(), {"--threads", "1"});
  const ProgramResult result = Call(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Written("rare.txt"));
  EXPECT_NE(result.out.find("small: failures by multilevel splitting"), std::string::npos) << result.out;
  EXPECT_NE(Written("rare.csv").find("\nsmall,1,0.3,ours,failure,rate,"), std::string::npos);
  EXPECT_NE(Written("rare.json").find("rcme rare 2"), std::string::npos);
  const std::string once = Written("rare.json");
  arguments.back() = "2";
  ASSERT_EQ(Call(arguments).exit_code, 0);
  EXPECT_EQ(Written("rare.json"), once);
}

TEST_F(RareProgram, Stratifies) {
  const ProgramResult strata =
      Call({"--method", "stratified", "--trials", "1000", "--set", "severity=skipped"});
  ASSERT_EQ(strata.exit_code, 0) << strata.err;
  EXPECT_NE(strata.out.find("1 in 64"), std::string::npos) << strata.out;
  EXPECT_NE(Written("rare.json").find("\"stratified\""), std::string::npos);
}

TEST_F(RareProgram, SaysWhatIsWrong) {
  const ProgramResult noise = Call({"--set", "noise=laplace"});
  EXPECT_EQ(noise.exit_code, 2);
  EXPECT_NE(noise.err.find("gaussian"), std::string::npos) << noise.err;
  EXPECT_EQ(Call({"--method", "guess"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(out_ + "/rare.csv"));
}

}  // namespace
}  // namespace rcme
