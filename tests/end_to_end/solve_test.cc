// From a study to the level of a setting at which a rate crosses a value.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

class SolveProgram : public testing::Test {
 protected:
  ProgramResult Call(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"solve", study_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  std::string Written(const std::string& name) { return ReadBytes(out_ + "/" + name); }

  TempFolder folder_;
  std::string study_ = folder_.Write("study.yaml", SmallStudyYaml());
  std::string out_ = folder_.Path("solved");
  const std::vector<std::string> few_ = {
      "--over",     "outlier_ratio",      "--from", "0", "--to", "0.95", "--at", "0.5", "--trials", "200",
      "--quantity", "failure_or_refusal", "--out",  out_};
};

TEST_F(SolveProgram, GivesTheSameOnAnyNumberOfThreads) {
  std::vector<std::string> arguments = few_;
  arguments.insert(arguments.end(), {"--threads", "1"});
  const ProgramResult result = Call(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Written("crossings.txt"));
  EXPECT_FALSE(std::filesystem::exists(out_ + "/unfinished.part"));
  const std::string once = Written("crossings.json");
  arguments.back() = "3";
  ASSERT_EQ(Call(arguments).exit_code, 0);
  EXPECT_EQ(Written("crossings.json"), once);

  const auto json = nlohmann::json::parse(once);
  EXPECT_EQ(json.at("format"), "rcme crossings 1");
  for (const auto& row : json.at("crossings")) {
    // Without outliers hardly any trial fails, with 95 % of them hardly any succeeds.
    EXPECT_GT(row.at("estimate"), 0.05) << row;
    EXPECT_LT(row.at("estimate"), 0.94) << row;
    std::int64_t num_trials = 0;
    for (const char* part : {"searched", "fresh"}) {
      for (const auto& level : row.at(part)) num_trials += level.at("n").get<std::int64_t>();
    }
    EXPECT_EQ(row.at("trials"), num_trials);
    EXPECT_EQ(num_trials, 200);
  }
}

// Trials of two levels that shared their scenes would not be independent.
TEST_F(SolveProgram, EveryLevelHasScenesOfItsOwn) {
  ASSERT_EQ(Call(few_).exit_code, 0);
  const std::string apart = Written("crossings.json");
  study_ = folder_.Write("common.yaml", SmallStudyYaml() + "common_scenes: true\n");
  ASSERT_EQ(Call(few_).exit_code, 0);
  EXPECT_EQ(Written("crossings.json"), apart);
}

TEST_F(SolveProgram, RealPairsAreRefused) {
  const std::string exported = folder_.Path("exported");
  ASSERT_EQ(RunRcme({"export", study_, "--trials", "2", "--out", exported}).exit_code, 0);
  study_ = folder_.Write("pairs.yaml", "name: pairs\ndata: {scene: match_files, folder: '" + exported +
                                           "/matches', sigma_px: 0.5}\nestimators:\n  - {name: standard}\n");
  const ProgramResult result = Call({"--over", "sigma_px", "--from", "0.1", "--to", "2"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("the pairs of a folder repeat"), std::string::npos) << result.err;
}

TEST_F(SolveProgram, SettingsThatAreWholeNumbersAreAskedAsSuch) {
  const ProgramResult result = Call(
      {"--over", "num_matches", "--from", "10", "--to", "40", "--falling", "--at", "0.3", "--trials", "100"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("falls below 0.3"), std::string::npos) << result.out;
}

TEST_F(SolveProgram, SaysWhatIsWrong) {
  const auto expect_error = [&](const std::vector<std::string>& arguments, const std::string& words) {
    const ProgramResult result = Call(arguments);
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_NE(result.err.find(words), std::string::npos) << result.err;
  };
  expect_error({"--over", "scene"},
               "'scene' is no factor of the study with levels that are numbers; give --from and --to");
  expect_error({"--over", "scene", "--from", "0", "--to", "1"}, "scene");
  expect_error({"--over", "outlier_ratio", "--from", "0.5", "--to", "0.2"},
               "--from 0.5 is not below --to 0.2");
  expect_error({"--over", "outlier_ratio", "--from", "0", "--to", "0.5", "--scale", "log"},
               "--scale log needs --from above 0");
  expect_error({"--over", "outlier_ratio", "--from", "0", "--to", "2"}, "outlier_ratio");
  expect_error({"--over", "sigma_px", "--from", "0.1", "--to", "2", "--estimator", "nobody"},
               "the study has no estimator 'nobody'");
  expect_error({"--over", "sigma_px", "--from", "0.1", "--to", "2", "--set", "repeats_per_scene=2"},
               "repeats");
}

}  // namespace
}  // namespace rcme
