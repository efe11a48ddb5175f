// From a study to the same study at equal time, and on to a run.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "experiments/study/study_file.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

constexpr double kTimeMs = 0.5;

class BudgetProgram : public testing::Test {
 protected:
  ProgramResult Budget(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"budget", study_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  // Exit code 2, the words on standard error, no file.
  void ExpectRefused(const std::vector<std::string>& more, const std::string& words) {
    const ProgramResult result = Budget(more);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
    EXPECT_EQ(result.err.find("internal error"), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(out_)) << words;
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("study.yaml", SmallStudyYaml()), out_ = folder_.Path("at_time.yaml");
};

// The times themselves belong to the machine, and other work beside disturbs them: only that more effort was
// found than the study's 20 hypotheses, which take far less than the time.
TEST_F(BudgetProgram, WritesTheStudyWithItsEfforts) {
  const ProgramResult result = Budget({"--time-ms", "0.5", "--calls", "2", "--out", out_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const std::string words :
       {"estimator", "ms a call, fresh trials", "standard", "ours", "Means of 4 calls"})
    EXPECT_NE(result.out.find(words), std::string::npos) << words << " is not in\n" << result.out;
  EXPECT_NE(result.err.find("next: rcme run " + out_), std::string::npos) << result.err;

  const Study before = ParseStudy(SmallStudyYaml(), "small.yaml"), after = LoadStudy(out_);
  ASSERT_EQ(after.estimators.size(), 2u);
  for (size_t e = 0; e < 2; ++e) {
    EXPECT_GT(std::stoi(ReadOption(after.estimators[e], "num_iterations")), 20) << after.estimators[e].label;
    for (const auto& [option, value] : before.estimators[e].options) {
      if (option == "num_iterations") continue;
      EXPECT_EQ(ReadOption(after.estimators[e], option), value) << option;
    }
    EXPECT_EQ(after.estimators[e].budget_ms.value_or(kTimeMs),
              kTimeMs);  // not there where it was not reached
  }

  const std::string run = folder_.Path("run.sqlite");
  ASSERT_EQ(RunRcme({"run", out_, "--trials", "2", "--out", run}).exit_code, 0);
  const ProgramResult summary = RunRcme({"summarize", run});
  ASSERT_EQ(summary.exit_code, 0) << summary.err;
  EXPECT_NE(summary.out.find("num_iterations"), std::string::npos) << summary.out;
}

TEST_F(BudgetProgram, SaysWhichTimeIsOutOfReach) {
  const ProgramResult result = Budget({"--time-ms", "0.001", "--calls", "1", "--out", out_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("takes longer even at its least effort"), std::string::npos) << result.out;
}

TEST_F(BudgetProgram, RefusesWhatCannotBe) {
  ExpectRefused({"--time-ms", "0", "--out", out_}, "--time-ms");
  ExpectRefused({"--time-ms", "1", "--calls", "0", "--out", out_}, "--calls");
  ExpectRefused({"--time-ms", "1", "--out", folder_.Path("none/x.yaml")}, "none");
  ExpectRefused({"--time-ms", "1", "--out", study_}, study_);
  EXPECT_EQ(ReadBytes(study_), SmallStudyYaml());
  ExpectRefused({"--time-ms", "1"}, "--out");
  ExpectRefused({"--out", out_}, "--time-ms");
}

TEST_F(BudgetProgram, Help) {
  const ProgramResult result = RunRcme({"budget", "--help"});
  EXPECT_EQ(result.exit_code, 0);
  for (const std::string words : {"STUDY", "--time-ms", "--calls", "--out", "Examples:"})
    EXPECT_NE(result.out.find(words), std::string::npos) << words;
}

}  // namespace
}  // namespace rcme
