// A study in shards gives the bytes of one run: by 1, 7 and 64 of them, with shards that are killed, cut off
// by a time limit, lost and made again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using Paths = std::vector<std::string>;

class Shards : public testing::Test {
 protected:
  std::vector<std::string> RunArguments(const std::string& out, const std::string& shard) const {
    return {"run", study_, "--out", out, "--trials", "600", "--threads", "1", "--shard", shard};
  }
  std::string Part(int number, int count) const {
    return folder_.Path(fmt::format("part_{}_of_{}.sqlite", number, count));
  }
  void Run(int number, int count) const {
    const ProgramResult result =
        RunRcme(RunArguments(Part(number, count), fmt::format("{}/{}", number, count)));
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  // SIGKILL as soon as the file has its tables: most often in the midst of its trials.
  void RunAndKill(int number, int count) const {
    const std::string out = Part(number, count);
    RunningProgram program(RcmeCommand(RunArguments(out, fmt::format("{}/{}", number, count))));
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(2);
    std::error_code no_file;
    while (!(std::filesystem::file_size(out, no_file) > 8192 && !no_file) && !program.HasEnded() &&
           std::chrono::steady_clock::now() < limit)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.Kill();
  }
  static std::string Bytes(const std::string& run) {
    std::string text;
    for (const std::vector<std::string>& format :
         {std::vector<std::string>{"--format", "csv"}, std::vector<std::string>{"--format", "json"},
          std::vector<std::string>{"--raw", "csv"}}) {
      std::vector<std::string> arguments = {"summarize", run};
      arguments.insert(arguments.end(), format.begin(), format.end());
      const ProgramResult result = RunRcme(arguments);
      EXPECT_EQ(result.exit_code, 0) << result.err;
      text += result.out;
    }
    return text;
  }
  static ProgramResult Merge(const Paths& parts, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"merge"};
    arguments.insert(arguments.end(), parts.begin(), parts.end());
    arguments.insert(arguments.end(), options.begin(), options.end());
    return RunRcme(arguments);
  }
  std::string Merged(const Paths& parts, const std::string& name, bool is_partial = false) const {
    const std::string out = folder_.Path(name + ".sqlite");
    std::vector<std::string> options = {"--out", out};
    if (is_partial) options.emplace_back("--partial");
    const ProgramResult result = Merge(parts, options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return out;
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
};

TEST_F(Shards, KilledLostAndMadeAgainGiveTheBytesOfOneRun) {
  const std::string run = folder_.Path("run.sqlite");
  ASSERT_EQ(RunRcme({"run", study_, "--out", run, "--trials", "600"}).exit_code, 0);
  const std::string whole = Bytes(run);
  for (const int count : {1, 7, 64}) {
    Paths parts;
    for (int number = 1; number <= count; ++number) parts.push_back(Part(number, count));
    const std::vector<int> killed = count == 1 ? std::vector<int>{1} : std::vector<int>{2, 3, 5};
    for (const int number : killed) RunAndKill(number, count);
    for (int number = 1; number <= count; ++number) Run(number, count);
    if (count > 1) {
      std::filesystem::remove(parts[3]);
      Paths others = parts;
      others.erase(others.begin() + 3);
      const ProgramResult check = Merge(others, {"--check"});
      EXPECT_EQ(check.exit_code, 75);
      EXPECT_EQ(check.out, "4\n") << check.err;
      EXPECT_EQ(Merge(others, {"--out", folder_.Path("no.sqlite")}).exit_code, 75);
      EXPECT_FALSE(std::filesystem::exists(folder_.Path("no.sqlite")));
      Run(4, count);
    }
    const ProgramResult check = Merge(parts, {"--check"});
    EXPECT_EQ(check.exit_code, 0) << check.err;
    EXPECT_EQ(check.out, "");
    EXPECT_EQ(Bytes(Merged(parts, fmt::format("in_order_{}", count))), whole) << count;
    std::ranges::reverse(parts);
    const auto half = parts.begin() + count / 2;
    Paths groups = {Merged({half, parts.end()}, fmt::format("second_half_{}", count), true)};
    if (count > 1) groups.push_back(Merged({parts.begin(), half}, fmt::format("first_half_{}", count), true));
    EXPECT_EQ(Bytes(Merged(groups, fmt::format("in_groups_{}", count))), whole) << count;
  }
}

TEST_F(Shards, EndInTimeAndGoOn) {
  const std::string out = Part(1, 2);
  std::vector<std::string> arguments = RunArguments(out, "1/2");
  arguments[5] = "100000000";  // so many that no run of this test ends
  arguments.insert(arguments.end(), {"--max-time", "0.3s"});
  const ProgramResult first = RunRcme(arguments), second = RunRcme(arguments);
  EXPECT_EQ(first.exit_code, 75) << first.err;
  EXPECT_THAT(first.err, HasSubstr("the same command resumes"));
  EXPECT_EQ(second.exit_code, 75) << second.err;
  const ProgramResult check = RunRcme({"check", out});
  EXPECT_EQ(check.exit_code, 0) << check.out;
  arguments.back() = "5";
  EXPECT_EQ(RunRcme(arguments).exit_code, 2);
}

TEST_F(Shards, KnowTheirNumberFromTheScheduler) {
  const std::string run = fmt::format("$RCME run {} --out {} --shard auto/9", study_, Part(5, 9));
  EXPECT_EQ(RunShell("SLURM_ARRAY_TASK_ID=5 " + run).exit_code, 0);
  EXPECT_EQ(RunShell("JOB_COMPLETION_INDEX=4 " + run).exit_code, 0) << "the same shard";
  EXPECT_EQ(RunShell("SLURM_ARRAY_TASK_ID=6 " + run).exit_code, 2) << "another one into its file";
  EXPECT_EQ(RunShell(run).exit_code, 2) << "no task at all";
  EXPECT_EQ(Merge({Part(5, 9)}, {"--check"}).out, "1-4,6-9\n");
}

TEST_F(Shards, KeepCountsToTheSameBytes) {
  const auto run = [&](const std::string& out, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = {"run", study_, "--out", out, "--trials", "600", "--keep", "counts"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  const auto summary = [](const std::string& path) {
    return RunRcme({"summarize", path, "--format", "json"}).out + RunRcme({"summarize", path}).out;
  };
  const std::string whole = folder_.Path("whole.sqlite");
  run(whole, {});
  const Paths parts = {Part(1, 3), Part(2, 3), Part(3, 3)};
  for (int number = 1; number <= 3; ++number) run(Part(number, 3), {"--shard", fmt::format("{}/3", number)});
  EXPECT_EQ(Merge({parts[0], parts[2]}, {"--check"}).out, "2\n");
  EXPECT_EQ(summary(Merged(parts, "counts")), summary(whole));
  EXPECT_GT(summary(whole).size(), 10'000u);
  EXPECT_EQ(RunRcme({"check", whole}).exit_code, 0);
  EXPECT_EQ(RunRcme({"compare", whole}).exit_code, 2);
  EXPECT_EQ(RunRcme({"summarize", whole, "--raw", "csv"}).exit_code, 2);
}

TEST_F(Shards, GoInRoundsUntilIntervalsAreNarrow) {
  const std::vector<std::string> until = {"run", study_, "--threads", "1", "--until", "ci=0.06", "--out"};
  const auto run = [&](const std::string& out, const std::vector<std::string>& options) {
    std::vector<std::string> arguments = until;
    arguments.push_back(out);
    arguments.insert(arguments.end(), options.begin(), options.end());
    return RunRcme(arguments);
  };
  const std::string whole = folder_.Path("whole.sqlite");
  const ProgramResult alone = run(whole, {});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  std::string merged;
  for (int round = 0; round < 10; ++round) {
    int exit_code = 0;
    for (int number = 1; number <= 2; ++number) {
      std::vector<std::string> options = {"--shard", fmt::format("{}/2", number)};
      if (!merged.empty()) options.insert(options.end(), {"--merged", merged});
      exit_code = run(Part(number, 2), options).exit_code;
      EXPECT_THAT(exit_code, testing::AnyOf(0, 75));
    }
    if (exit_code == 0) break;
    merged = Merged({Part(1, 2), Part(2, 2)}, fmt::format("round_{}", round));
  }
  const ProgramResult last = run(merged, {});
  EXPECT_EQ(last.exit_code, 0) << last.err;
  EXPECT_EQ(last.out, alone.out) << "the table of what was spent";
  EXPECT_EQ(Bytes(merged), Bytes(whole));
}

}  // namespace
}  // namespace rcme
