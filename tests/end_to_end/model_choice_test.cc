// From a study to the confusion matrices of model choice, and on to their figure.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

class ModelChoiceProgram : public testing::Test {
 protected:
  ProgramResult Call(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"model-choice", study_, "--out", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  std::string Written(const std::string& name) { return ReadBytes(out_ + "/" + name); }

  TempFolder folder_;
  std::string study_ = folder_.Write("study.yaml", SmallStudyYaml());
  std::string out_ = folder_.Path("choice");
};

TEST_F(ModelChoiceProgram, WritesWhatItPrints) {
  const ProgramResult result = Call({"--trials", "3", "--by", "outlier_ratio"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Written("model_choice.txt"));
  for (const char* part : {"small: verdicts of model choice", "3 trials in each of 2 conditions",
                           "outlier_ratio = 0\n", "outlier_ratio = 0.3\n", "plunder_dl"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " is not in\n" << result.out;
  }
  EXPECT_NE(Written("model_choice.csv").find("\nsmall,1,0.3,general,general,gric,share,rate,1,"),
            std::string::npos);
  EXPECT_NE(Written("model_choice.json").find("rcme model choice 2"), std::string::npos);
}

TEST_F(ModelChoiceProgram, IsTheSameOnAnyNumberOfThreads) {
  ASSERT_EQ(Call({"--trials", "3", "--threads", "1"}).exit_code, 0);
  const std::string once = Written("model_choice.csv");
  ASSERT_EQ(Call({"--trials", "3", "--threads", "2"}).exit_code, 0);
  EXPECT_EQ(Written("model_choice.csv"), once);
}

TEST_F(ModelChoiceProgram, SaysWhatIsWrong) {
  const ProgramResult unknown = Call({"--by", "sigma_px"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("outlier_ratio"), std::string::npos) << unknown.err;
  EXPECT_EQ(Call({"--trials", "0"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(out_ + "/model_choice.csv"));
}

}  // namespace
}  // namespace rcme
