// A run gives the same summary, byte for byte, with one thread, with two, and killed half-way and resumed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include "experiments/run/store/result_store.h"
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

// So many trials that no run of a test ends.
constexpr int kEndless = 2'000'000'000;

std::uintmax_t ReadFileSize(const std::string& path) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  return error ? 0 : size;
}

// A run without an end that is under way: the file has grown by so many bytes, committed or not.
class EndlessRun {
 public:
  EndlessRun(const std::string& study, const std::string& out, std::uintmax_t growth)
      : size_before_(ReadFileSize(out)), program_(RcmeCommand(RunArguments(study, out, kEndless, 2))) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(5);
    while (ReadFileSize(out) < size_before_ + growth && !program_.HasEnded() &&
           std::chrono::steady_clock::now() < limit) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    EXPECT_FALSE(program_.HasEnded()) << program_.Wait().err;
  }
  RunningProgram& program() { return program_; }

 private:
  std::uintmax_t size_before_;
  RunningProgram program_;
};

// Trials in a result file that nobody holds: how many, and one more than the last.
struct Held {
  int count = 0;
  int end = 0;
};

Held TrialsIn(const std::string& path) {
  Held held;
  ResultStore::OpenForReading(path).ForEachRecord([&](const TrialRecord& record) {
    held.count += record.estimator == 0 ? 1 : 0;
    held.end = std::max(held.end, static_cast<int>(record.trial) + 1);
  });
  return held;
}

// The killed runs have no end, so that every kill is half-way however fast or loaded the machine is; a last
// run asks for a few trials more than they left.
TEST(Resume, ThreadsAndKillsChangeNothing) {
  const TempFolder folder;
  const std::string study = folder.Write("small.yaml", SmallStudyYaml());
  const std::string one = folder.Path("one.sqlite"), two = folder.Path("two.sqlite"),
                    cut = folder.Path("cut.sqlite");
  Held held;
  // A kill before the first commit keeps nothing new: the next one comes later.
  std::uintmax_t growth = 100'000;
  for (int num_kept = 0; num_kept < 2; growth *= 2) {
    ASSERT_LT(growth, 1'000'000'000u) << "nothing is ever committed";
    EndlessRun(study, cut, growth).program().Kill();
    const Held now = TrialsIn(cut);
    EXPECT_GE(now.count, held.count) << "a kill lost trials that were there before";
    num_kept += now.count > held.count;
    held = now;
  }
  const int num_trials = held.end + 20;
  const ProgramResult resumed = RunRcme(RunArguments(study, cut, num_trials, 2));
  ASSERT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_NE(resumed.err.find(fmt::format("({} were there already)", held.count)), std::string::npos)
      << resumed.err;
  ASSERT_EQ(RunRcme(RunArguments(study, one, num_trials, 1)).exit_code, 0);
  ASSERT_EQ(RunRcme(RunArguments(study, two, num_trials, 2)).exit_code, 0);

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

// Ctrl-C and SIGTERM: the trials in hand are kept, and the message says how many there are.
TEST(Resume, AfterARequestToStop) {
  const TempFolder folder;
  const std::string study = folder.Write("small.yaml", SmallStudyYaml());
  for (const int signal : {SIGINT, SIGTERM}) {
    const std::string cut = folder.Path(fmt::format("cut_{}.sqlite", signal));
    EndlessRun run(study, cut, 100'000);
    run.program().Send(signal);
    const ProgramResult stopped = run.program().Wait();
    EXPECT_EQ(stopped.exit_code, 128 + signal) << stopped.err;
    const Held held = TrialsIn(cut);
    const std::string message =
        fmt::format("stopped, {} trials kept; the same command resumes\n", held.count);
    EXPECT_NE(stopped.err.find(message), std::string::npos) << stopped.err;
    const ProgramResult resumed = RunRcme(RunArguments(study, cut, held.end + 1, 2));
    EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
    EXPECT_NE(resumed.err.find(fmt::format("({} were there already)", held.count)), std::string::npos)
        << resumed.err;
  }
}

}  // namespace
}  // namespace rcme
