// What the program answers where its output cannot be written, or would destroy something: exit code 2, a
// sentence on standard error that names the thing, and nothing lost or left behind.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"

namespace rcme {
namespace {

class BadOutput : public BadInput {};

TEST_F(BadOutput, UnwritableOutput) {
  EXPECT_TRUE(
      IsRefused(Run({"--out", folder_.Path("none/run.sqlite")}), {"none/run.sqlite", "does not exist"}));
  EXPECT_TRUE(IsRefused(Run({"--out", folder_.path()}), {folder_.path(), "is a folder"}));
  EXPECT_TRUE(IsRefused(Run({"--out", ""}), {"--out", "''"}));
  EXPECT_TRUE(IsRefused(Run({"--out", study_}), {"small.yaml", "is not an rcme result file"}));
  EXPECT_EQ(ReadBytes(study_), SmallStudyYaml());
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  EXPECT_TRUE(IsRefused(RunRcme({"summarize", out_, "--out", folder_.Path("none/table")}),
                        {"none/table", "cannot be"}));
  EXPECT_TRUE(IsRefused(RunRcme({"summarize", out_, "--out", folder_.path()}),
                        {folder_.path(), "cannot be written"}));
  EXPECT_EQ(folder_.NumEntries(), 2) << "something was left behind";
}

TEST_F(BadOutput, FullOutput) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  EXPECT_TRUE(IsRefused(Run({"--out", "/dev/full"}), {"/dev/full", "cannot be written"}));
  for (const std::string format : {"table", "csv", "json"}) {
    EXPECT_TRUE(IsRefused(RunRcme({"summarize", out_, "--format", format, "--out", "/dev/full"}),
                          {"/dev/full", "No space left"}));
    EXPECT_TRUE(IsRefused(RunShell("\"$RCME\" summarize '" + out_ + "' --format " + format + " > /dev/full"),
                          {"standard output", "cannot be written"}));
  }
  const std::string matches = folder_.Write("m.csv", MatchHeader() + MatchRows(50));
  for (const std::string& command :
       {"estimate '" + matches + "'", "replay '" + out_ + "' --condition 0 --trial 0", std::string("list")}) {
    EXPECT_TRUE(IsRefused(RunShell("\"$RCME\" " + command + " > /dev/full"),
                          {"standard output", "cannot be written"}));
  }
}

// Messages that cannot be written are lost, and nothing else is: neither the work nor its exit code.
TEST_F(BadOutput, MessagesThatCannotBeWritten) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const std::string run = "\"$RCME\" run '" + folder_.Write("small.yaml", SmallStudyYaml()) + "' --out '";
  for (const std::string& stream : {std::string("2>/dev/full"), std::string("2>&-")}) {
    const std::string out = folder_.Path("messages.sqlite");
    std::filesystem::remove(out);
    EXPECT_EQ(RunShell(run + out + "' " + stream).exit_code, 0) << stream;
    EXPECT_EQ(RunRcme({"summarize", out}).exit_code, 0) << stream;
    EXPECT_EQ(RunShell("\"$RCME\" summarize no_such_file " + stream).exit_code, 2) << stream;
    EXPECT_EQ(RunShell("\"$RCME\" list scenes > /dev/full " + stream).exit_code, 2) << stream;
    EXPECT_EQ(RunShell("\"$RCME\" list scenes >&- " + stream).exit_code, 2) << stream;
    EXPECT_EQ(RunShell("\"$RCME\" --help > /dev/full " + stream).exit_code, 2) << stream;
  }
}

TEST_F(BadOutput, ADiskThatFillsUpLosesNothingThatWasThere) {
  // A file-size limit (1 block: 512 bytes) stands for the full disk; the signal that comes with it is
  // ignored.
  const std::string run = "\"$RCME\" run '" + study_ + "' --out '" + out_ + "' --threads 1 --trials ";
  ASSERT_EQ(RunShell(run + "20").exit_code, 0);
  EXPECT_TRUE(
      IsRefused(RunShell("trap '' XFSZ; ulimit -f 60; " + run + "2000"), {out_, "cannot be written"}));
  const ProgramResult after = RunShell(run + "20");
  EXPECT_EQ(after.exit_code, 0);
  EXPECT_NE(after.err.find("(40 were there already)"), std::string::npos) << after.err;
  EXPECT_EQ(RunRcme({"summarize", out_}).exit_code, 0);
}

TEST_F(BadOutput, ResultsOfAnotherStudy) {
  ASSERT_EQ(Run({"--out", out_}).exit_code, 0);
  const std::string bytes = ReadBytes(out_);
  EXPECT_TRUE(IsRefused(Run({"--out", out_, "--seed", "9"}),
                        {"run.sqlite", "another study", "'seed: 3' there, 'seed: 9' here", "--out"}));
  EXPECT_TRUE(
      IsRefused(Run({"--out", out_, "--set", "ours.mu=-1"}), {"run.sqlite", "another study", "mu: -1"}));
  EXPECT_EQ(ReadBytes(out_), bytes);
}

// An output onto what is read, or onto the results of a run, would destroy it.
TEST_F(BadOutput, OutputOntoAnInput) {
  const std::string study = folder_.Write("study.yaml", SmallStudyYaml()), run = folder_.Path("run.sqlite");
  ASSERT_EQ(RunRcme({"run", study, "--trials", "2", "--out", run}).exit_code, 0);
  const std::string before = ReadBytes(run);
  for (const char* command : {"summarize", "compare", "report"}) {
    EXPECT_TRUE(IsRefused(RunRcme({command, run, "--out", run}), {run, "results of a run", "not replaced"}));
  }
  EXPECT_EQ(ReadBytes(run), before);
  const std::string tuned = folder_.Write(
      "tuned.yaml", SmallStudyYaml() + "tune: {estimator: ours, calibrate: 100, options: {mu: [5]}}\n");
  EXPECT_TRUE(IsRefused(RunRcme({"tune", tuned, "--out", tuned}), {"--out", "is the input itself"}));
  // A table beside match files would be read as one of them.
  const std::string pairs = folder_.Path("pairs");
  std::filesystem::create_directory(pairs);
  folder_.Write("pairs/one.csv", MatchHeader() + MatchRows(60));
  for (const char* command : {"check-truth", "validate", "twin"})
    EXPECT_TRUE(IsRefused(RunRcme({command, pairs, "--out", pairs}), {"--out", "is the input itself"}))
        << command;
}

}  // namespace
}  // namespace rcme
