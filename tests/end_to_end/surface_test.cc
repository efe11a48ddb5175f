// `rcme surface` as a user runs it: a run of a population, its surface, the proposed study, and both
// together.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_support/result_formats.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;

std::string PopulationYaml(const std::string& conditions) {
  return "name: drawn\nseed: 3\ntrials: 6\n"
         "data: {scene: uniform_volume}\n" +
         conditions +
         "estimators:\n"
         "  - {name: standard, options: {num_iterations: 20}}\n";
}

class SurfaceProgram : public testing::Test {
 protected:
  // The result file of a study that is run.
  std::string Run(const std::string& name, const std::string& yaml) {
    const std::string study = folder_.Write(name + ".yaml", yaml), run = folder_.Path(name + ".sqlite");
    const ProgramResult result = RunRcme({"run", study, "--out", run, "--threads", "1"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return run;
  }
  ProgramResult Call(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"surface", "--out", out_, "--no-figures"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  void ExpectRefused(const std::vector<std::string>& arguments, const std::string& named) {
    const ProgramResult result = Call(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_THAT(result.err, HasSubstr(named));
  }

  TempFolder folder_;
  std::string out_ = folder_.Path("surface");
  const std::string drawn_ = PopulationYaml(
      "conditions:\n  number: 32\n  ranges: {outlier_ratio: [0, 0.9], sigma_px: {log: [0.1, 3]}, "
      "num_matches: [20, 60]}\n");
};

TEST_F(SurfaceProgram, ProposesConditionsThatRunAndAreAddedToTheSurface) {
  const std::string run = Run("drawn", drawn_);
  const ProgramResult first = Call({run, "--propose", "4"});
  ASSERT_EQ(first.exit_code, 0) << first.err;
  EXPECT_THAT(first.out, HasSubstr("All are random draws"));
  EXPECT_EQ(ReadBytes(out_ + "/indices.csv").substr(0, 6), "group,");
  ExpectFormatsAgree({"surface", "--out", folder_.Path("formats"), "--no-figures", run});

  const std::string next = Run("next", ReadBytes(out_ + "/next.yaml"));
  const ProgramResult both = Call({run, next});
  ASSERT_EQ(both.exit_code, 0) << both.err;
  EXPECT_THAT(both.out, HasSubstr("36 conditions"));
  EXPECT_THAT(both.out, HasSubstr("32 are random draws"));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/next.yaml"));
}

TEST_F(SurfaceProgram, LevelsThatSomebodyChoseAreNoPopulation) {
  const std::string run = Run(
      "grid", PopulationYaml("factors: {outlier_ratio: [0, 0.2, 0.4, 0.6, 0.8], sigma_px: [0.2, 0.5, 1, 2], "
                             "num_matches: [30]}\n"));
  const ProgramResult result = Call({run});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("None of them is a"));
  ExpectRefused({run, "--estimator", "nobody"}, "nobody");
  ExpectRefused({run, "--propose", "4"}, "--propose");
  ExpectRefused({run, Run("drawn", drawn_)}, "other factors");
}

}  // namespace
}  // namespace rcme
