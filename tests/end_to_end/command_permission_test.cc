// A command that a file brings runs only where it is allowed, whichever command of the program reads the
// file.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "tests/test_support/match_text.h"
#include "tests/test_support/refusal_of_first.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using Arguments = std::vector<std::string>;

class CommandPermission : public testing::Test {
 protected:
  // A process that leaves a file behind where it runs, and refuses every problem.
  std::string Script() {
    return folder_.Write("refuse.sh",
                         "touch '" + marker_ + "'\n" +
                             "while read -r line; do\n"
                             "  id=${line#*'\"id\": \"'}; id=${id#*'\"id\":\"'}; id=${id%%'\"'*}\n"
                             "  echo \"{\\\"id\\\": \\\"$id\\\", \\\"status\\\": "
                             "\\\"no_candidate\\\", \\\"message\\\": \\\"none\\\"}\"\n"
                             "done\n");
  }
  std::string StudyText(const std::string& entry) {
    return "name: theirs\ntrials: 2\ndata: {scene: uniform_volume, num_matches: 40}\nestimators:\n"
           "  - {name: standard, options: {num_iterations: 20}}\n" +
           entry;
  }
  bool HasRun() { return std::filesystem::remove(marker_); }

  // Refused, with the command, the line where it stands and what would allow it; and it did not run.
  void ExpectRefused(const Arguments& arguments, const std::string& place) {
    const ProgramResult result = RunRcme(arguments);
    EXPECT_FALSE(HasRun()) << arguments[0] << " ran the command";
    EXPECT_EQ(result.exit_code, 2) << arguments[0] << ": " << result.err;
    for (const std::string& said : {command_, place, std::string("--allow-process")})
      EXPECT_NE(result.err.find(said), std::string::npos)
          << arguments[0] << " does not say " << said << ": " << result.err;
  }
  // It runs, after it was shown.
  ProgramResult ExpectAllowed(Arguments arguments) {
    arguments.emplace_back("--allow-process");
    const ProgramResult result = RunRcme(arguments);
    EXPECT_TRUE(HasRun()) << arguments[0] << ": " << result.err;
    EXPECT_NE(result.err.find("runs the command '" + command_), std::string::npos) << result.err;
    return result;
  }

  TempFolder folder_;
  std::string marker_ = folder_.Path("it_ran");
  std::string command_ = "sh " + Script();
  std::string study_ =
      folder_.Write("theirs.yaml", StudyText("  - {process: '" + command_ + "', label: mine}\n"));
  std::string place_ = "theirs.yaml:6";
  std::string file_ = folder_.Write("theirs_estimator.yaml", "label: mine\nprocess: '" + command_ + "'\n");
  std::string out_ = folder_.Path("out");
};

TEST_F(CommandPermission, OfAStudy) {
  for (const Arguments& arguments :
       std::vector<Arguments>{{"run", study_, "--out", out_},
                              {"run", study_, "--out", out_, "--keep", "counts"},
                              {"show", study_, "--condition", "0", "--trial", "0", "--out", out_},
                              {"budget", study_, "--time-ms", "1", "--calls", "1", "--out", out_},
                              {"rare", study_, "--out", out_},
                              {"rare", study_, "--method", "stratified", "--trials", "1000", "--out", out_},
                              {"audit", study_, "--out", out_},
                              {"audit", study_, "--plan"}}) {
    ExpectRefused(arguments, place_);
    EXPECT_FALSE(std::filesystem::exists(out_)) << arguments[0] << " wrote something";
  }
  EXPECT_EQ(ExpectAllowed({"run", study_, "--out", out_}).exit_code, 0);
}

TEST_F(CommandPermission, ItsNameAndOptionAreACommandToo) {
  const std::string study = folder_.Write(
      "long.yaml",
      StudyText("  - name: process\n    label: mine\n    options:\n      command: '" + command_ + "'\n"));
  ExpectRefused({"run", study, "--out", out_}, "long.yaml:9");
}

TEST_F(CommandPermission, OfAStudyThatIsTuned) {
  const std::string tune =
      "tune: {estimator: mine, target: failure, at_most: 0.9, options: {timeout_s: [5, 10]}}\n";
  const std::string study =
      folder_.Write("tuned.yaml", StudyText("  - {process: '" + command_ + "', label: mine}\n") + tune);
  ExpectRefused({"tune", study, "--out", out_}, "tuned.yaml:6");
  ExpectRefused({"transfer", study, "--out", out_}, "tuned.yaml:6");
  // A command among the levels would be one more: there is none.
  const std::string levels = folder_.Write(
      "levels.yaml", StudyText("  - {name: process, label: mine}\n") +
                         "tune: {estimator: mine, target: failure, at_most: 0.9, options: {command: ['" +
                         command_ + "']}}\n");
  const ProgramResult result = RunRcme({"tune", levels, "--out", out_, "--allow-process"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("levels.yaml:7: tune: options: command"), std::string::npos) << result.err;
  EXPECT_FALSE(HasRun());
}

TEST_F(CommandPermission, OfAnEstimatorFile) {
  const std::string small = folder_.Write("small.yaml", SmallStudyYaml());
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(30));
  const std::string place = "theirs_estimator.yaml:2";
  ExpectRefused({"run", small, "--add-estimator", file_, "--out", out_}, place);
  const std::string naming = folder_.Write("naming.yaml", StudyText("  - {file: theirs_estimator.yaml}\n"));
  ExpectRefused({"run", naming, "--out", out_}, place);
  for (const Arguments& arguments : std::vector<Arguments>{{"estimate", matches},
                                                           {"check-estimator"},
                                                           {"validate", folder_.path()},
                                                           {"calibrate-noise", folder_.path()},
                                                           {"check-truth", folder_.path()},
                                                           {"twin", folder_.path(), "--out", out_}}) {
    Arguments with_file = arguments;
    with_file.insert(with_file.end(), {"--estimator-file", file_});
    ExpectRefused(with_file, place);
  }
  ExpectAllowed({"estimate", matches, "--estimator-file", file_});
  EXPECT_EQ(ExpectAllowed({"run", small, "--add-estimator", file_, "--out", out_}).exit_code, 0);
}

TEST_F(CommandPermission, OfAResultFile) {
  ASSERT_EQ(ExpectAllowed({"run", study_, "--out", out_}).exit_code, 0);
  std::filesystem::remove(study_);
  const Arguments trial = {"--condition", "0", "--trial", "1"};
  for (const char* command : {"replay", "show"}) {
    Arguments arguments = {command, out_};
    arguments.insert(arguments.end(), trial.begin(), trial.end());
    ExpectRefused(arguments, "out (its study):");
  }
  Arguments arguments = {"replay", out_};
  arguments.insert(arguments.end(), trial.begin(), trial.end());
  EXPECT_EQ(ExpectAllowed(arguments).exit_code, 0);
}

TEST_F(CommandPermission, OfTheStudyOfAnImport) {
  const std::string folder = folder_.Path("problems");
  ASSERT_EQ(RunRcme({"export", study_, "--out", folder}).exit_code, 0);
  const std::string answers =
      folder_.Write("answers.jsonl", RefusalOfFirst(ReadBytes(folder + "/problems.jsonl")));
  ExpectRefused({"import", answers, "--study", study_, "--label", "theirs", "--out", out_}, place_);
  ExpectAllowed({"import", answers, "--study", study_, "--label", "theirs", "--out", out_});
}

// What asks no estimator needs no permission.
TEST_F(CommandPermission, NothingIsRefusedWhereNothingRuns) {
  const std::string folder = folder_.Path("problems");
  EXPECT_EQ(RunRcme({"export", study_, "--out", folder}).exit_code, 0);
  EXPECT_EQ(RunRcme({"model-choice", study_, "--trials", "1", "--out", folder}).exit_code, 0);
  EXPECT_EQ(RunRcme({"map", study_, "--trials", "1", "--out", folder}).exit_code, 0);
  EXPECT_FALSE(HasRun());
  ASSERT_EQ(ExpectAllowed({"run", study_, "--out", out_}).exit_code, 0);
  EXPECT_EQ(RunRcme({"summarize", out_}).exit_code, 0);
  EXPECT_EQ(RunRcme({"check", out_}).exit_code, 0);
  EXPECT_FALSE(HasRun());
}

TEST_F(CommandPermission, WhatTheCommandLineGivesIsTheCallersOwn) {
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(30));
  RunRcme({"estimate", matches, "--estimator", "process", "--set", "command=" + command_});
  EXPECT_TRUE(HasRun());
  const std::string other = folder_.Write("other.yaml", StudyText("  - {process: 'exit 1', label: mine}\n"));
  const ProgramResult result = RunRcme({"run", other, "--set", "mine.command=" + command_, "--out", out_});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_TRUE(HasRun());
  // Another option of it makes the file's command nobody's own.
  ExpectRefused({"run", study_, "--set", "mine.timeout_s=5", "--out", out_ + "2"}, place_);
}

TEST_F(CommandPermission, AllOfACommandIsShown) {
  const std::string study = folder_.Write(
      "hidden.yaml", StudyText("  - {process: \"echo \\e[8m; echo \\u202E\\nrm x\", label: mine}\n"));
  const ProgramResult control = RunRcme({"run", study, "--out", out_});
  EXPECT_EQ(control.exit_code, 2);
  EXPECT_EQ(control.err.find('\x1B'), std::string::npos) << control.err;
  const std::string many = "true " + std::string(3000, ' ') + "; touch '" + marker_ + "'";
  const std::string with_room =
      folder_.Write("room.yaml", StudyText("  - {process: \"" + many + "\", label: mine}\n"));
  const ProgramResult result = RunRcme({"run", with_room, "--out", out_, "--allow-process"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("too long"), std::string::npos) << result.err;
  EXPECT_FALSE(HasRun());
}

}  // namespace
}  // namespace rcme
