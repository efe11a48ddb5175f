// Estimators that are processes, in the program: a command that cannot start, one that never answers, Ctrl-C,
// a SIGKILL of the program, answers that are asked for again.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "tests/test_support/descendants.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Clock = std::chrono::steady_clock;

constexpr int kTrials = 6;

// A folder with a study, an estimator file and its script. In the script, `ask` reads a problem and `answer`
// answers it with a rotation about nothing and a direction to the right.
class ProcessEstimators : public testing::Test {
 protected:
  void SetUp() override {
    std::ofstream(study_) << "name: asked\nseed: 1\ntrials: " << kTrials
                          << "\ndata: {scene: uniform_volume, num_matches: 60, sigma_px: 0.5}\n"
                             "estimators:\n  - {name: standard, options: {num_iterations: 20}}\n";
  }
  void UseCommand(const std::string& command, double timeout_s = 60.0) const {
    std::ofstream(estimator_) << "process: \"" << command
                              << "\"\nlabel: asked\noptions: {timeout_s: " << timeout_s << "}\n";
  }
  void UseScript(const std::string& script, double timeout_s = 60.0) const {
    std::ofstream(script_) << R"sh(
ask() { IFS= read -r line || exit 0; id=${line#*\"id\":\"}; id=${id%%\"*}; }
answer() { printf '{"id":"%s","R":[1,0,0,0,1,0,0,0,1],"t":[1,0,0]}\n' "$id"; }
cd ')sh" << folder_.path() << "' || exit\n"
                           << script << "\n";
    UseCommand("exec sh " + script_, timeout_s);
  }
  std::vector<std::string> RunArguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {
        "run", study_, "--allow-process", "--add-estimator", estimator_, "--out", out_, "--threads", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  // How often the process ended with each status.
  std::map<std::string, int> Statuses() const {
    std::map<std::string, int> counts;
    ResultStore::OpenForReading(out_).ForEachRecord([&](const TrialRecord& record) {
      if (record.estimator == 1) ++counts[StatusName(record.status)];
    });
    return counts;
  }
  // Until a script has made the file.
  void WaitFor(const std::string& file) const {
    const Clock::time_point limit = Clock::now() + std::chrono::minutes(1);
    while (!std::ifstream(file) && Clock::now() < limit)
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_TRUE(std::ifstream(file).good()) << file;
  }

  const TempFolder folder_;
  const std::string study_ = folder_.Path("study.yaml"), estimator_ = folder_.Path("asked.yaml"),
                    script_ = folder_.Path("script.sh"), out_ = folder_.Path("run.sqlite");
};

TEST_F(ProcessEstimators, ACommandThatCannotStartEndsTheRunBeforeItsFirstTrial) {
  for (const std::string command :
       {"no_such_program_at_all", "/etc/passwd", "exit 3", "true", "kill -9 $$"}) {
    UseCommand(command);
    const ProgramResult result = RunRcme(RunArguments());
    EXPECT_EQ(result.exit_code, 2) << command;
    EXPECT_THAT(result.err, HasSubstr("'" + command + "' cannot be used"));
    EXPECT_THAT(result.err, Not(HasSubstr("done")));
  }
  UseScript("while ask; do answer; done");  // another command, the same file
  const ProgramResult result = RunRcme(RunArguments());
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(ResultStore::OpenForReading(out_).NumTrials(), kTrials);
}

TEST_F(ProcessEstimators, NoCommandWorksWithOneThatCannotStart) {
  UseCommand("exit 127");
  const std::string matches = folder_.Path("problems/matches");
  ASSERT_EQ(RunRcme({"export", study_, "--trials", "1", "--out", folder_.Path("problems")}).exit_code, 0);
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"estimate", matches, "--allow-process", "--estimator-file", estimator_},
        {"run", study_, "--allow-process", "--add-estimator", estimator_, "--out", folder_.Path("counts"),
         "--keep", "counts"},
        {"audit", study_, "--allow-process", "--add-estimator", estimator_, "--out", folder_.Path("audit")},
        {"rare", study_, "--allow-process", "--add-estimator", estimator_, "--out", folder_.Path("rare")}}) {
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments.front();
    EXPECT_THAT(result.err, HasSubstr("'exit 127' cannot be used")) << arguments.front();
  }
}

TEST_F(ProcessEstimators, OneThatRefusesEverythingIsAWarning) {
  UseScript(R"(while ask; do printf '{"id":"%s","status":"no_candidate"}\n' $id; done)");
  const ProgramResult run = RunRcme(RunArguments());
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err,
              HasSubstr("warning: asked refused every one of the 6 trials run now (no_candidate 6); rcme "
                        "replay " +
                        out_ + " --condition 0 --trial 0 --allow-process shows why\n"));
  EXPECT_THAT(run.err, Not(HasSubstr("standard refused")));
  EXPECT_THAT(RunRcme({"summarize", out_}).err, HasSubstr("warning: asked refused every trial"));
  EXPECT_THAT(RunRcme({"summarize", out_}).err, Not(HasSubstr("standard")));
}

TEST_F(ProcessEstimators, AnswersOfTwoVersionsOfAScriptAreNotMixed) {
  const std::string good = "while ask; do answer; done";
  UseScript(good);
  ASSERT_EQ(RunRcme(RunArguments({"--trials", "3"})).exit_code, 0);
  UseScript(good + "  # another version");
  for (const std::vector<std::string>& command :
       {RunArguments(), {"replay", out_, "--condition", "0", "--trial", "0", "--allow-process"}}) {
    const ProgramResult refused = RunRcme(command);
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("file " + script_ + " of estimator asked is not what it was"));
  }
  EXPECT_EQ(RunRcme({"summarize", out_}).exit_code, 0) << "what is there can be read";
  UseScript(good);
  EXPECT_EQ(RunRcme(RunArguments()).exit_code, 0);
  EXPECT_EQ(ResultStore::OpenForReading(out_).NumTrials(), kTrials);
}

// The check of a process that fails, and that of one that states no covariance.
TEST_F(ProcessEstimators, ChecksNameCommandsThatCanBePasted) {
  UseScript("while ask; do answer; done");
  const ProgramResult failed = RunRcme(
      {"check-estimator", "--estimator-file", estimator_, "--allow-process", "--only", "conventions"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.out, HasSubstr("reproduce: rcme check-estimator --estimator-file " + estimator_ +
                                    " --seed 1 --only conventions --allow-process\n"));
  const ProgramResult without_covariance =
      RunRcme({"check-estimator", "--estimator-file", estimator_, "--allow-process", "--only", "answers"});
  EXPECT_EQ(without_covariance.exit_code, 0) << without_covariance.out;
  EXPECT_THAT(without_covariance.out, HasSubstr("not checked: covariance computed by rcme from its inliers"));
  ASSERT_EQ(RunRcme(RunArguments()).exit_code, 0);
  EXPECT_THAT(RunRcme({"summarize", out_}).out,
              HasSubstr("asked: where an answer states none, the coverage"));
}

// Whatever the process has started, in whatever session.
TEST_F(ProcessEstimators, NothingOutlivesAProgramThatIsKilled) {
  UseScript(
      "export RCME_CASE=\"$PWD\"; if mkdir probed; then ask; answer; exit; fi; ask; answer; trap '' TERM HUP "
      "INT\n"
      "setsid sh -c 'trap \"\" TERM HUP; sleep 300; :' & (setsid sleep 300 &) ; touch hangs; ask; sleep 300; "
      ":",
      1000.0);
  RunningProgram program(RcmeCommand(RunArguments()));
  WaitFor(folder_.Path("hangs"));
  EXPECT_FALSE(ProcessesNaming(script_).empty());
  program.Kill();
  EXPECT_THAT(ProcessesLeft(folder_.path()), IsEmpty());
}

// Within 2 s, whatever timeout_s says, and the trial that is cut off has no outcome.
TEST_F(ProcessEstimators, SignalsEndAWaitAndLeaveNoRefusal) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(folder_.Path("probed"));
    std::filesystem::remove(folder_.Path("hangs"));
    // The first problem of a run is not of a trial.
    UseScript("if mkdir probed; then ask; answer; exit; fi; ask; answer; ask; touch hangs; sleep 300",
              1000.0);
    RunningProgram program(RcmeCommand(RunArguments()));
    WaitFor(folder_.Path("hangs"));
    const Clock::time_point start = Clock::now();
    program.Send(signal);
    const ProgramResult result = program.Wait();
    EXPECT_LT(Clock::now() - start, std::chrono::seconds(2));
    EXPECT_EQ(result.exit_code, 128 + signal);
    EXPECT_THAT(result.err, HasSubstr("the same command resumes"));
    const std::map<std::string, int> statuses = Statuses();
    EXPECT_EQ(statuses.count("no_answer") + statuses.count("timed_out"), 0u);
    EXPECT_THAT(ProcessesLeft(folder_.path()), IsEmpty());
  }
}

TEST_F(ProcessEstimators, ASignalEndsTheFirstProblemToo) {
  UseScript("ask; touch hangs; sleep 300", 1000.0);
  RunningProgram program(RcmeCommand(RunArguments()));
  WaitFor(folder_.Path("hangs"));
  const Clock::time_point start = Clock::now();
  program.Send(SIGINT);
  EXPECT_EQ(program.Wait().exit_code, 130);
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(2));
}

TEST_F(ProcessEstimators, MissingAnswersAreAskedForAgain) {
  const std::string good = "while ask; do answer; done";
  UseScript(good);
  ASSERT_EQ(RunRcme(RunArguments()).exit_code, 0);
  const auto raw = [&] { return RunRcme({"summarize", out_, "--raw", "csv"}).out; };
  const std::string expected = raw();
  std::filesystem::remove(out_);
  // Three of the processes end after they have been asked; the first is asked before the first trial.
  UseScript(
      "if mkdir a 2>/dev/null; then ask; answer; exit; fi\n"
      "for n in 1 2 3; do if mkdir $n 2>/dev/null; then ask; exit; fi; done\n" +
      good);
  const ProgramResult first = RunRcme(RunArguments());
  ASSERT_EQ(first.exit_code, 0);
  EXPECT_THAT(first.err,
              HasSubstr("warning: asked gave no valid answer in any of the 6 trials run now (no_answer 3, "
                        "invalid_covariance 3); rcme replay " +
                        out_ + " --condition 0 --trial "));
  EXPECT_THAT(first.err,
              HasSubstr(" --allow-process shows why; rcme run with --retry no_answer asks again\n"));
  EXPECT_EQ(Statuses()["no_answer"], 3);
  const ProgramResult retried = RunRcme(RunArguments({"--retry", "no_answer,timed_out"}));
  EXPECT_EQ(retried.exit_code, 0) << retried.err;
  EXPECT_THAT(retried.err, HasSubstr("3 trials are run again, which the file notes"));
  EXPECT_EQ(Statuses().count("no_answer"), 0u);
  EXPECT_EQ(raw(), expected) << "as if every answer had come at once";
  EXPECT_EQ(ResultStore::OpenForReading(out_).Description().retried_trials, 3);
  EXPECT_THAT(RunRcme({"summarize", out_}).out, HasSubstr("3 trials were run again"));
  const std::string bytes = ReadBytes(out_);
  EXPECT_THAT(RunRcme(RunArguments({"--retry", "no_answer"})).err, HasSubstr("0 trials are run again"));
  EXPECT_EQ(ReadBytes(out_), bytes) << "nothing to retry, nothing written";
  EXPECT_EQ(RunRcme(RunArguments({"--retry", "too_uncertain"})).exit_code, 2) << "that is an answer";
  EXPECT_EQ(RunRcme({"check", out_}).exit_code, 0);
}

}  // namespace
}  // namespace rcme
