// Problems that are answered elsewhere: what `rcme export` writes and what `rcme import` refuses.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/refusal_of_first.h"

namespace rcme {
namespace {

using testing::HasSubstr;

class Export : public BadInput {
 protected:
  ProgramResult RunExport(const std::string& num_trials) {
    return RunRcme({"export", study_, "--trials", num_trials, "--out", exported_});
  }
  // The first lines of the match files, which name their scenes.
  std::multiset<std::string> Scenes() const {
    std::multiset<std::string> scenes;
    for (const auto& entry : std::filesystem::directory_iterator(exported_ + "/matches")) {
      const std::string text = ReadBytes(entry.path().string());
      scenes.insert(text.substr(0, text.find('\n')));
    }
    return scenes;
  }

  std::string exported_ = folder_.Path("exported");
};

TEST_F(Export, NamesTheConditionAndLeavesNoFileOfAnEarlierExport) {
  ASSERT_EQ(RunExport("3").exit_code, 0);
  EXPECT_EQ(Scenes().size(), 6U);
  folder_.Write("exported/matches/mine.csv", "# scene: mine\n");
  ASSERT_EQ(RunExport("1").exit_code, 0);
  EXPECT_EQ(Scenes(), (std::multiset<std::string>{"# scene: mine", "# scene: outlier_ratio 0",
                                                  "# scene: outlier_ratio 0.3"}));
}

// The exported study names the folder of its pairs, which is not beside it, so that `rcme import` finds it.
TEST_F(Export, OfPairsInAFolderIsImportedFromAnyFolder) {
  std::filesystem::create_directory(folder_.Path("pairs"));
  folder_.Write("pairs/one.csv", MatchHeader() + MatchRows(60));
  const std::string study = folder_.Write(
      "of_pairs.yaml",
      "name: p\ntrials: 1\ndata: {scene: match_files, folder: none}\nestimators: [{name: standard}]\n");
  const std::string from_here = std::filesystem::relative(folder_.Path("pairs")).string();
  ASSERT_EQ(RunRcme({"export", study, "--set", "folder=" + from_here, "--out", exported_}).exit_code, 0);
  EXPECT_THAT(ReadBytes(exported_ + "/study.yaml"), HasSubstr("folder: " + folder_.Path("pairs")));
  const std::string answers = folder_.Write("answers.jsonl", "");
  const ProgramResult imported = RunRcme({"import", answers, "--study", exported_ + "/study.yaml", "--label",
                                          "mine", "--out", folder_.Path("imported.sqlite")});
  EXPECT_THAT(imported.err, HasSubstr("holds no answer to a problem of"));  // so it read the pairs
}

TEST_F(Export, AnyNumberOfThreadsGivesTheSameBytes) {
  const auto bytes_with = [&](const std::string& threads) {
    EXPECT_EQ(
        RunRcme({"export", study_, "--trials", "20", "--threads", threads, "--out", exported_}).exit_code, 0);
    std::map<std::string, std::string> bytes;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(exported_)) {
      if (entry.is_regular_file()) bytes[entry.path().string()] = ReadBytes(entry.path().string());
    }
    std::filesystem::remove_all(exported_);
    return bytes;
  };
  const auto one = bytes_with("1");
  EXPECT_EQ(one.size(), 43U);
  EXPECT_EQ(one, bytes_with("3"));
}

TEST_F(Export, SaysWhatIsWrittenWhenItIsStopped) {
  RunningProgram program(RcmeCommand({"export", study_, "--trials", "100000", "--out", exported_}));
  const std::string matches = exported_ + "/matches";
  while (!program.HasEnded() && (!std::filesystem::exists(matches) || std::filesystem::is_empty(matches))) {
  }
  program.Send(SIGINT);
  const ProgramResult stopped = program.Wait();
  EXPECT_EQ(stopped.exit_code, 130);
  EXPECT_THAT(stopped.err, HasSubstr(" match files of 200000 trials are in " + matches));
  EXPECT_FALSE(std::filesystem::exists(exported_ + "/problems.jsonl"));
}

// The noise that the study's estimators are told, which may differ from that of its matches.
TEST_F(Export, WritesTheNoiseThatEstimatorsAssume) {
  const auto assumed_after = [&](const std::vector<std::string>& settings,
                                 const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"export", study_, "--trials", "1", "--out", exported_};
    arguments.insert(arguments.end(), settings.begin(), settings.end());
    EXPECT_EQ(RunRcme(arguments).exit_code, 0);
    arguments = {"estimate", exported_ + "/matches", "--estimator", "standard", "--format", "json"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const nlohmann::json answers = nlohmann::json::parse(RunRcme(arguments).out);
    std::set<double> assumed;
    for (const auto& row : answers.at("rows"))
      assumed.insert(row.at("evidence").at("sigma_assumed_px").get<double>());
    return assumed;
  };
  const std::vector<std::string> noisy = {"--set", "sigma_px=2"};
  EXPECT_EQ(assumed_after(noisy, {}), (std::set<double>{2.0}));
  EXPECT_EQ(assumed_after(noisy, {"--sigma", "0.75"}), (std::set<double>{0.75}));
  EXPECT_EQ(assumed_after({"--set", "sigma_px=2", "--set", "assumed_sigma_px=1.5"}, {}),
            (std::set<double>{1.5}));
}

TEST_F(Export, AnswersToNoProblemAreRefusedBeforeTheStudyRuns) {
  ASSERT_EQ(RunExport("2").exit_code, 0);
  const std::string out = folder_.Path("run.sqlite");
  const auto import = [&](const std::string& answers) {
    return RunRcme({"import", folder_.Write("answers.jsonl", answers), "--study", exported_ + "/study.yaml",
                    "--label", "mine", "--out", out});
  };
  EXPECT_TRUE(IsRefused(import(""), {"answers.jsonl", "holds no answer to a problem"}));
  EXPECT_TRUE(IsRefused(import("{\"id\": \"a\", \"status\": \"no_candidate\"}\n"), {"holds no answer"}));
  EXPECT_FALSE(std::filesystem::exists(out));
  const ProgramResult one = import(RefusalOfFirst(ReadBytes(exported_ + "/problems.jsonl")));
  EXPECT_EQ(one.exit_code, 0) << one.err;
  EXPECT_THAT(one.err, HasSubstr("3 of 4 trials have no answer"));
}

}  // namespace
}  // namespace rcme
