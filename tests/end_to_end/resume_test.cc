// A run gives the same summary, byte for byte, with one thread, with two, and killed half-way and resumed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "experiments/result_store.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

std::vector<std::string> RunArguments(const std::string& study, const std::string& out, int num_trials,
                                      int num_threads) {
  return {"run",       study,
          "--out",     out,
          "--trials",  std::to_string(num_trials),
          "--threads", std::to_string(num_threads)};
}

std::string Csv(const std::string& run) {
  const ProgramResult result = RunRcme({"summarize", run, "--format", "csv"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return result.out;
}

// Runs the study on one thread; returns trials per condition enough to be killed on the way.
int RunLongEnough(const std::string& study, const std::string& out) {
  for (int num_trials = 400;; num_trials *= 4) {
    std::filesystem::remove(out);
    const auto start = std::chrono::steady_clock::now();
    EXPECT_EQ(RunRcme(RunArguments(study, out, num_trials, 1)).exit_code, 0);
    if (std::chrono::steady_clock::now() - start > std::chrono::seconds(3) || testing::Test::HasFailure()) {
      return num_trials;
    }
  }
}

// Trials in a result file that nobody holds.
int CountTrials(const std::string& path) {
  int count = 0;
  ResultStore::OpenForReading(path).ForEachRecord(
      [&](const TrialRecord& record) { count += record.estimator == 0 ? 1 : 0; });
  return count;
}

TEST(Resume, ThreadsAndKillsChangeNothing) {
  const TempFolder folder;
  const std::string study = folder.Write("small.yaml", SmallStudyYaml());
  const std::string one = folder.Path("one.sqlite"), two = folder.Path("two.sqlite"),
                    cut = folder.Path("cut.sqlite");
  const int num_trials = RunLongEnough(study, one);
  ASSERT_EQ(RunRcme(RunArguments(study, two, num_trials, 2)).exit_code, 0);

  int num_kills = 0, num_before = 0;
  for (int attempt = 0; attempt < 20 && num_kills < 2; ++attempt) {
    RunningProgram program(RcmeCommand(RunArguments(study, cut, num_trials, 2)));
    // The file grows by a commit about twice a second; kill a little after one.
    const auto size = [&] { return std::filesystem::exists(cut) ? std::filesystem::file_size(cut) : 0; };
    const auto size_at_start = std::max<std::uintmax_t>(size(), 40'000);
    while (!program.HasEnded() && size() <= size_at_start) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    if (program.HasEnded()) break;
    program.Kill();
    const int num_done = CountTrials(cut);
    EXPECT_GE(num_done, num_before) << "a kill lost trials that were there before";
    if (num_done > 0 && num_done < 2 * num_trials) ++num_kills;
    num_before = num_done;
  }
  ASSERT_GE(num_kills, 1) << "the run was never caught half-way";
  ASSERT_LT(num_before, 2 * num_trials);
  const ProgramResult resumed = RunRcme(RunArguments(study, cut, num_trials, 2));
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find(fmt::format("({} were there already)", num_before)), std::string::npos)
      << resumed.err;

  const std::string csv = Csv(one);
  EXPECT_GT(csv.size(), 1000u);
  EXPECT_EQ(Csv(two), csv);
  EXPECT_EQ(Csv(cut), csv);
  for (const std::string& trial : {std::string("0"), std::string("17"), std::to_string(num_trials - 1)}) {
    const ProgramResult replay = RunRcme({"replay", cut, "--condition", "1", "--trial", trial});
    EXPECT_EQ(replay.exit_code, 0) << replay.err;
    EXPECT_EQ(replay.out.find("DIFFERENT"), std::string::npos) << replay.out;
    const size_t first = replay.out.find("the record in the file:   the same");
    ASSERT_NE(first, std::string::npos) << replay.out;
    EXPECT_NE(replay.out.find("the record in the file:   the same", first + 1), std::string::npos)
        << replay.out;
  }
  const ProgramResult beyond =
      RunRcme({"replay", cut, "--condition", "1", "--trial", std::to_string(num_trials)});
  EXPECT_NE(beyond.out.find("not run yet"), std::string::npos) << beyond.out;
}

}  // namespace
}  // namespace rcme
