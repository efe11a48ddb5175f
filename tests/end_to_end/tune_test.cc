// From a study to a tuned estimator, and on to a run and a pair.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_support/match_text.h"
#include "tests/test_support/result_formats.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/tuned_study.h"
#include "tests/test_support/without_python.h"

namespace rcme {
namespace {

class TuneProgram : public testing::Test {
 protected:
  ProgramResult Tune(const std::vector<std::string>& more) { return Call("tune", more); }
  ProgramResult Call(const std::string& command, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {command, study_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  // Exit code 2 and these words on standard error; no tuned estimator.
  testing::AssertionResult IsRefused(const ProgramResult& result, const std::vector<std::string>& fragments) {
    if (result.exit_code != 2) return testing::AssertionFailure() << result.exit_code << ": " << result.err;
    for (const std::string& fragment : fragments) {
      if (result.err.find(fragment) == std::string::npos)
        return testing::AssertionFailure() << "no '" << fragment << "' in: " << result.err;
    }
    if (result.err.find("internal error") != std::string::npos)
      return testing::AssertionFailure() << result.err;
    if (std::filesystem::exists(out_)) return testing::AssertionFailure() << "a file was written";
    return testing::AssertionSuccess();
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("study.yaml", TunedYaml("  target: failure\n"
                                                             "  at_most: 0.3\n"
                                                             "  max_refusal: 0.9\n"
                                                             "  explore: 10\n"
                                                             "  calibrate: 20\n"
                                                             "  verify: 10\n"
                                                             "  options: {mu: [1, 2, 3, 6]}\n"));
  std::string out_ = folder_.Path("tuned.yaml");
};

TEST_F(TuneProgram, WritesAnEstimatorThatOtherCommandsTake) {
  const ProgramResult tuned = Tune({"--out", out_});
  ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
  for (const char* part :
       {"small: 4 settings of ours", "2 conditions; 20 trials to explore, 40 to calibrate",
        "Target: at most 30 % of the trials fail", "Tuned: mu = ", "optimism", "standard"}) {
    EXPECT_NE(tuned.out.find(part), std::string::npos) << part << " is not in\n" << tuned.out;
  }
  const std::string run = folder_.Path("run.sqlite");
  ASSERT_EQ(Call("run", {"--add-estimator", out_, "--out", run, "--threads", "1"}).exit_code, 0);
  EXPECT_NE(RunRcme({"summarize", run}).out.find("ours_tuned"), std::string::npos);
  const std::string matches = folder_.Write("m.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  const ProgramResult pair = RunRcme({"estimate", matches, "--estimator-file", out_, "--format=json"});
  ASSERT_EQ(pair.exit_code, 0) << pair.err;
  EXPECT_EQ(nlohmann::json::parse(pair.out)["estimator"], "ours_tuned");
}

// A run of the study with its own seed would take the trials it was tuned on.
TEST_F(TuneProgram, SuggestsARunOnOtherTrials) {
  EXPECT_NE(Tune({"--out", out_}).err.find("--seed 4"), std::string::npos);
}

TEST_F(TuneProgram, TheSameBytesWhateverTheThreads) {
  const WithoutPython without_figures;
  std::vector<std::string> files, outs;
  for (const char* threads : {"1", "2"}) {
    const std::string figures = folder_.Path("figures");
    const ProgramResult result = Tune({"--out", out_, "--figures", figures, "--threads", threads});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    files.push_back(ReadBytes(out_) + ReadBytes(figures + "/tune.json"));
    outs.push_back(result.out);
    EXPECT_GT(std::filesystem::file_size(figures + "/tune.json"), 1000u);
    std::filesystem::remove_all(figures);
  }
  EXPECT_EQ(files[0], files[1]);
  EXPECT_EQ(outs[0], outs[1]);
}

TEST_F(TuneProgram, AnUnreachableTargetNamesTheNearestFigure) {
  EXPECT_TRUE(IsRefused(Tune({"--out", out_, "--set", "sigma_px=8", "--tune", "max_refusal=0.1"}),
                        {"study.yaml", "no setting is certified", "nearest is mu = ", "refusal", "10 %"}));
}

// With what was changed on the command line the figures cannot be found again from study and seed alone.
TEST_F(TuneProgram, TheProvenanceSaysWhatWasChanged) {
  ASSERT_EQ(Tune({"--out", out_, "--set", "sigma_px=0.4", "--set", "max_rotation_error_deg=5"}).exit_code, 0);
  const std::string text = ReadBytes(out_);
  EXPECT_NE(text.find("changed: sigma_px=0.4, max_rotation_error_deg=5"), std::string::npos) << text;
  EXPECT_NE(text.find("rotation error above 5 deg"), std::string::npos) << text;
}

TEST_F(TuneProgram, TooFewTrialsSayHowManyWouldDo) {
  EXPECT_TRUE(IsRefused(Tune({"--out", out_, "--tune", "at_most=0.01"}),
                        {"calibrate: 20 in each of 2 conditions", "299 trials would do", "calibrate: 150"}));
}

TEST_F(TuneProgram, BadInput) {
  const auto refuses = [&](const std::string& tune, const std::vector<std::string>& fragments) {
    return IsRefused(Tune({"--out", out_, "--tune", tune}), fragments);
  };
  EXPECT_TRUE(refuses("goal=1", {"'goal'", "known keys", "at_most", "calibrate"}));
  EXPECT_TRUE(refuses("at_most", {"at_most", "''", "a number in"}));
  EXPECT_TRUE(refuses("at_most=0", {"at_most", "'0'", "a number in"}));
  EXPECT_TRUE(refuses("at_most=nan", {"at_most", "'nan'", "a number in"}));
  EXPECT_TRUE(refuses("max_refusal=0", {"max_refusal", "'0'", "a number in"}));
  EXPECT_TRUE(refuses("delta=1", {"delta", "'1'", "a number in"}));
  EXPECT_TRUE(refuses("calibrate=0", {"calibrate", "'0'", "a whole number"}));
  EXPECT_TRUE(
      refuses("target=speed", {"target", "'speed'", "false_refusal, failure, accepted_failure, risk"}));
  EXPECT_TRUE(refuses("estimator=theirs", {"estimator", "'theirs'", "standard, ours"}));
  EXPECT_TRUE(IsRefused(Tune({}), {"--out"}));
  EXPECT_TRUE(IsRefused(Tune({"--shard", "1/2", "--out", out_, "--repeat", "3"}), {"--repeat", "--shard"}));
  EXPECT_TRUE(IsRefused(Tune({"--figures", folder_.Path("f"), "--repeat", "3"}), {"--repeat", "--figures"}));
  EXPECT_TRUE(IsRefused(Tune({"--repeat", "0"}), {"--repeat", "0"}));
  const std::string shared = folder_.Write("shared.yaml", "common_scenes: true\n" + ReadBytes(study_));
  EXPECT_TRUE(
      IsRefused(RunRcme({"tune", shared, "--out", out_}), {"shared.yaml", "common_scenes", "leave it out"}));
  study_ = folder_.Write("repeated.yaml", "repeats_per_scene: 2\n" + ReadBytes(study_));
  EXPECT_TRUE(IsRefused(Tune({"--out", out_}), {"repeated.yaml", "repeats_per_scene", "leave it out"}));
  study_ = folder_.Write("plain.yaml", SmallStudyYaml());
  EXPECT_TRUE(IsRefused(Tune({"--out", out_}), {"plain.yaml", "no block 'tune'"}));
  EXPECT_TRUE(IsRefused(Call("transfer", {"--out", folder_.Path("t")}), {"plain.yaml", "no block 'tune'"}));
}

// Another estimator than in the file, which does not have one of the options.
TEST_F(TuneProgram, AnOptionThatTheEstimatorDoesNotHave) {
  std::string yaml = ReadBytes(study_);
  yaml.replace(yaml.find("{mu: "), 5, "{selection: [mean_entropy, predictive_likelihood], mu: ");
  study_ = folder_.Write("selection.yaml", yaml);
  EXPECT_TRUE(IsRefused(Tune({"--out", out_, "--tune", "estimator=standard"}),
                        {"estimator standard has no option 'selection'", "its options: solver, "}));
}

// Found before the work, which would take minutes here.
TEST_F(TuneProgram, APlaceThatCannotBeWrittenIsFoundAtOnce) {
  folder_.Write("file", "");
  for (const std::string& out : {folder_.Path("none/tuned.yaml"), folder_.Path("file/tuned.yaml"),
                                 folder_.path(), std::string("/proc/tuned.yaml")}) {
    const auto start = std::chrono::steady_clock::now();
    EXPECT_TRUE(IsRefused(Tune({"--out", out, "--tune", "verify=10000000"}), {out, "cannot be written"}));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << out;
  }
  EXPECT_EQ(folder_.NumEntries(), 2) << "something was left behind";
  ASSERT_EQ(Tune({"--out", out_}).exit_code, 0);
  const std::string before = ReadBytes(out_);
  EXPECT_EQ(Tune({"--out", out_, "--tune", "at_most=0.01"}).exit_code, 2);
  EXPECT_EQ(ReadBytes(out_), before) << "a tuning that was refused changed an earlier file";
}

TEST_F(TuneProgram, Repetitions) {
  const ProgramResult result = Tune({"--repeat", "5"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.out.find("tuned 5 times"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("promised at most 5 %"), std::string::npos) << result.out;
  EXPECT_EQ(Tune({"--repeat", "5", "--threads", "1"}).out, result.out);
  ExpectFormatsAgree({"tune", study_, "--repeat", "5"});
  EXPECT_TRUE(IsRefused(Tune({"--repeat", "5", "--out", study_}), {study_}));
  EXPECT_EQ(Tune({"--repeat", "5", "--out", out_}).out, result.out);
  EXPECT_EQ(ReadBytes(out_), result.out);
}

TEST_F(TuneProgram, Transfer) {
  const std::string out = folder_.Path("transfer");
  const ProgramResult result = Call("transfer", {"--out", out, "--by", "outlier_ratio"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(ReadBytes(out + "/transfer.txt"), result.out);
  const auto json = nlohmann::json::parse(ReadBytes(out + "/transfer.json"));
  EXPECT_EQ(json["families"].size(), 2u);
  EXPECT_NE(result.out.find("outlier_ratio = 0.3"), std::string::npos) << result.out;
  ExpectFormatsAgree({"transfer", study_, "--out", out, "--by", "outlier_ratio"});
  const std::string bytes = ReadBytes(out + "/transfer.json");
  ASSERT_EQ(Call("transfer", {"--out", out, "--threads", "1"}).exit_code, 0);
  EXPECT_EQ(ReadBytes(out + "/transfer.json"), bytes);
  EXPECT_TRUE(IsRefused(Call("transfer", {"--out", out, "--by", "scene"}), {"--by scene", "outlier_ratio"}));
  EXPECT_TRUE(IsRefused(Call("transfer", {"--out", out, "--tune", "target=risk"}), {"transfer", "risk"}));
  ExpectFormatsAgree({"tune", study_, "--out", out_});
}

}  // namespace
}  // namespace rcme
