// A result file of a program with an estimator of its own, read by the plain `rcme`, which does not know it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "experiments/core/text/program_name.h"
#include "experiments/run/run_study.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/test_estimators.h"

namespace rcme {
namespace {

using testing::HasSubstr;

class UnknownEstimator : public testing::Test {
 protected:
  UnknownEstimator() {
    AddTestEstimators();
    NameProgram("/somewhere/own_rcme");
    std::string yaml = SmallStudyYaml();
    yaml += "  - {name: peer}\n";
    const StudyPlan plan = MakePlan(ParseStudy(yaml, "own.yaml"));
    ResultStore store = ResultStore::OpenForRun(run_, plan);
    RunStudy(plan, 1, &store);
    NameProgram("rcme");
  }
  testing::AssertionResult IsRefusedFor(const std::vector<std::string>& command) const {
    const ProgramResult result = RunRcme(command);
    if (result.exit_code != 2) return testing::AssertionFailure() << "exit code " << result.exit_code;
    for (const char* part :
         {"unknown estimator 'peer'", "standard, prcme, rcme", "made by own_rcme (rcme "}) {
      if (result.err.find(part) == std::string::npos) return testing::AssertionFailure() << result.err;
    }
    return testing::AssertionSuccess();
  }

  TempFolder folder_;
  std::string run_ = folder_.Path("run.sqlite");
};

TEST_F(UnknownEstimator, IsSummarizedComparedReportedAndChecked) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"summarize", run_}, {"compare", run_, "--against", "peer"}}) {
    const ProgramResult result = RunRcme(command);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.out, HasSubstr("peer"));
  }
  const ProgramResult checked = RunRcme({"check", run_});
  EXPECT_EQ(checked.exit_code, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("own_rcme (rcme "));
  const std::string page = folder_.Path("report.html");
  const ProgramResult report = RunRcme({"report", run_, "--out", page});
  EXPECT_EQ(report.exit_code, 0) << report.err;
  EXPECT_THAT(ReadBytes(page), HasSubstr("min_inliers"));
}

TEST_F(UnknownEstimator, IsNotRunAgain) {
  EXPECT_TRUE(IsRefusedFor({"replay", run_, "--condition", "0", "--trial", "0"}));
  EXPECT_TRUE(
      IsRefusedFor({"show", run_, "--condition", "0", "--trial", "0", "--out", folder_.Path("a.png")}));
  // A study of this program has other estimators.
  const std::string study = folder_.Write("small.yaml", SmallStudyYaml());
  const ProgramResult more = RunRcme({"run", study, "--out", run_});
  EXPECT_EQ(more.exit_code, 2);
  EXPECT_THAT(more.err, HasSubstr("another study"));
  EXPECT_THAT(more.err, HasSubstr("own_rcme (rcme "));
}

}  // namespace
}  // namespace rcme
