// `rcme show` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_support/match_text.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Show : public testing::Test {
 protected:
  ProgramResult ShowTrial(const std::string& study, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"show", study, "--out", out_, "--json", json_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  nlohmann::json Shown() { return nlohmann::json::parse(ReadBytes(json_)); }
  void ExpectDrawn(const ProgramResult& result) {
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(ReadBytes(out_ + ".png"), StartsWith("\x89PNG\r\n"));
    EXPECT_THAT(ReadBytes(out_ + ".pdf"), StartsWith("%PDF"));
  }
  void ExpectRefused(const std::vector<std::string>& arguments, const std::vector<std::string>& fragments) {
    std::vector<std::string> command = {"show"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const std::ptrdiff_t num_entries = folder_.NumEntries();
    const ProgramResult result = RunRcme(command);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    for (const std::string& fragment : fragments) EXPECT_THAT(result.err, HasSubstr(fragment));
    EXPECT_THAT(result.err, Not(HasSubstr("internal error")));
    EXPECT_EQ(folder_.NumEntries(), num_entries) << "something was left behind";
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
  std::string run_ = folder_.Path("run.sqlite");
  std::string out_ = folder_.Path("trial"), json_ = folder_.Path("trial.json");
};

TEST_F(Show, DrawsATrialOfAStudyAndSaysHowItEnded) {
  const ProgramResult result = ShowTrial(study_, {"--condition", "1", "--trial", "4"});
  ExpectDrawn(result);
  EXPECT_THAT(result.out, HasSubstr("Study small, seed 3, condition 1, trial 4"));
  EXPECT_THAT(result.out, HasSubstr("ours"));
  EXPECT_THAT(result.err, HasSubstr("done: " + out_ + ".png, " + out_ + ".pdf"));
  const std::string png = ReadBytes(out_ + ".png");
  ExpectDrawn(ShowTrial(study_, {"--condition", "1", "--trial", "4"}));
  EXPECT_EQ(ReadBytes(out_ + ".png"), png) << "the same trial must give the same picture";
}

TEST_F(Show, AResultFileHasTheSameTrials) {
  ASSERT_EQ(RunRcme({"run", study_, "--out", run_, "--seed", "8", "--threads", "1"}).exit_code, 0);
  ExpectDrawn(ShowTrial(run_, {"--condition", "1", "--trial", "2", "--estimators", "ours,standard"}));
  const std::string of_run = ReadBytes(json_);
  EXPECT_EQ(Shown()["drawn"], nlohmann::json::parse("[1, 0]"));
  ExpectDrawn(ShowTrial(
      study_, {"--condition", "1", "--trial", "2", "--estimators", "ours,standard", "--seed", "8"}));
  EXPECT_EQ(ReadBytes(json_), of_run);
  ExpectRefused({run_, "--condition", "0", "--trial", "0", "--seed", "9"},
                {"run.sqlite", "--seed", "its own study and seed"});
  ExpectRefused({run_, "--condition", "0", "--trial", "0", "--set", "sigma_px=1"}, {"run.sqlite", "--set"});
}

TEST_F(Show, DrawsWhatHasNoDirectionNoSceneOrNoMotion) {
  ExpectDrawn(ShowTrial(study_, {"--condition", "1", "--trial", "0", "--set", "motion=pure_rotation"}));
  EXPECT_TRUE(Shown()["truth"]["F"].is_null());
  ExpectDrawn(ShowTrial(study_, {"--condition", "0", "--trial", "0", "--set", "outlier_ratio=1", "--set",
                                 "num_matches=7", "--set", "severity=skipped"}));
  EXPECT_EQ(Shown()["estimators"][0]["outcome"], "refusal");

  std::filesystem::create_directory(folder_.Path("pairs"));
  folder_.Write("pairs/a.csv", MatchHeader() + MatchRows(40));
  const std::string real =
      folder_.Write("real.yaml", "data: {scene: match_files, folder: " + folder_.Path("pairs") +
                                     "}\nestimators: [{name: rcme}]\n");
  ExpectDrawn(ShowTrial(real, {"--condition", "0", "--trial", "0"}));
  EXPECT_TRUE(Shown()["kinds"].is_null());
}

TEST_F(Show, DefaultNameIsThatOfTheTrial) {
  std::string yaml = SmallStudyYaml();
  yaml.replace(yaml.find("small"), 5, "'a/b $(c)'");
  folder_.Write("odd.yaml", yaml);
  const ProgramResult result =
      RunShell("cd '" + folder_.path() + "' && \"$RCME\" show odd.yaml --condition 1 --trial 9");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("beyond the 6 trials"));
  EXPECT_THAT(ReadBytes(folder_.Path("trial_a_b___c__c1_t9.png")), StartsWith("\x89PNG"));
}

TEST_F(Show, RefusesWhatItCannotShow) {
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = {study_, "--out", out_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  ExpectRefused({folder_.Path("none.yaml"), "--condition", "0", "--trial", "0"},
                {"none.yaml", "no such study"});
  ExpectRefused({folder_.path(), "--condition", "0", "--trial", "0"}, {"is a folder"});
  ExpectRefused(with({"--condition", "2", "--trial", "0"}), {"--condition", "2", "conditions 0 to 1"});
  ExpectRefused(with({"--condition", "0", "--trial", "-1"}), {"--trial", "-1"});
  ExpectRefused(with({"--condition", "0"}), {"--trial"});
  ExpectRefused(with({"--condition", "0", "--trial", "0", "--estimators", "ours,rcme"}),
                {"--estimators", "'rcme'", "allowed: standard, ours"});
  ExpectRefused(with({"--condition", "0", "--trial", "0", "--set", "garbage=1"}),
                {"'garbage'", "known keys"});
  ExpectRefused(with({"--condition", "0", "--trial", "0", "--set", "garbage"}), {"--set", "key=value"});
}

TEST_F(Show, SaysBeforehandWhatCannotBeWritten) {
  const std::vector<std::string> trial = {study_, "--condition", "0", "--trial", "0"};
  const auto to = [&](const std::string& option, const std::string& path) {
    std::vector<std::string> arguments = trial;
    arguments.insert(arguments.end(), {option, path});
    return arguments;
  };
  ExpectRefused(to("--out", folder_.Path("none/trial")), {"none/trial", "does not exist"});
  ExpectRefused(to("--out", folder_.Path("trial.png")), {"trial.png", "without .png or .pdf"});
  ExpectRefused(to("--out", ""), {"--out", "''"});
  ExpectRefused(to("--json", folder_.Path("none/trial.json")), {"none/trial.json", "cannot be written"});
  std::filesystem::create_directory(out_ + ".png");
  ExpectRefused(to("--out", out_), {"trial.png", "is a folder"});
}

}  // namespace
}  // namespace rcme
