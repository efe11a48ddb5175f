// rcme gate: its exit codes, what it writes, the same bytes for any number of threads, and how it goes on.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kWithoutTime = "failure,refusal,miscoverage,error";

class Gate : public BadInput {
 protected:
  ProgramResult RunGate(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"gate", study_, "--of", kWithoutTime};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  std::string Estimator(const std::string& name, const std::string& options) {
    return folder_.Write(name + ".yaml", "name: standard\nlabel: " + name + "\noptions: {" + options + "}\n");
  }
};

TEST_F(Gate, AnEqualVersionIsNotWorse) {
  const ProgramResult gate =
      RunGate({"--old", "standard", "--new", "standard", "--out", folder_.Path("equal")});
  EXPECT_EQ(gate.exit_code, 0) << gate.out << gate.err;
  EXPECT_THAT(gate.out, HasSubstr("standard_new is not worse than standard_old"));
  EXPECT_THAT(gate.out, HasSubstr("0 trials ended otherwise"));
  EXPECT_THAT(ReadBytes(folder_.Path("equal/gate.md")), HasSubstr("| failure | not worse |"));
  EXPECT_THAT(ReadBytes(folder_.Path("equal/gate.xml")), HasSubstr("failures=\"0\" errors=\"0\""));
  EXPECT_THAT(ReadBytes(folder_.Path("equal/gate.json")), HasSubstr("\"format\": \"rcme gate 1\""));
}

TEST_F(Gate, AWorseVersionEndsWithOneAndShowsItsTrials) {
  const std::string hasty = Estimator("hasty", "num_iterations: 1");
  const ProgramResult gate = RunGate({"--old", "standard", "--new", hasty, "--out", folder_.Path("worse")});
  EXPECT_EQ(gate.exit_code, 1) << gate.out << gate.err;
  EXPECT_THAT(gate.out, HasSubstr("hasty is worse than standard"));
  EXPECT_THAT(gate.out, HasSubstr("rcme show " + folder_.Path("worse/trials.sqlite") + " --condition "));
  EXPECT_THAT(ReadBytes(folder_.Path("worse/gate.xml")), HasSubstr("<failure message=\"worse: "));
}

TEST_F(Gate, IsUndecidedWithinTheBudget) {
  const ProgramResult few =
      RunGate({"--old", "standard", "--new", "standard", "--max-trials", "30", "--out", folder_.Path("few")});
  EXPECT_EQ(few.exit_code, 3) << few.out << few.err;
  EXPECT_THAT(few.out, HasSubstr("Undecided whether"));
  EXPECT_THAT(ReadBytes(folder_.Path("few/gate.xml")), HasSubstr("<error message=\"undecided: "));
}

TEST_F(Gate, JudgesOneVersionByALimit) {
  const auto judge = [&](const std::string& limit) {
    return RunRcme(
        {"gate", study_, "--new", "ours", "--failure-at-most", limit, "--out", folder_.Path("at" + limit)});
  };
  const ProgramResult loose = judge("0.9"), strict = judge("0.001");
  EXPECT_EQ(loose.exit_code, 0) << loose.out << loose.err;
  EXPECT_THAT(loose.out, HasSubstr("The failure rate of ours is below the limit, after"));
  EXPECT_THAT(loose.out, testing::ContainsRegex("quantity +verdict +pairs +new +rate\n"));
  EXPECT_THAT(loose.out, testing::ContainsRegex("quantity +limit\n"));
  EXPECT_THAT(loose.out, Not(HasSubstr("margin")));
  EXPECT_NE(strict.exit_code, 0);
  EXPECT_NE(strict.exit_code, 2) << strict.err;
}

TEST_F(Gate, ABaselineAndTwoFilesGiveTheVerdictOfOneRun) {
  const std::string before = folder_.Path("before.sqlite"), after = folder_.Path("after.sqlite");
  ASSERT_EQ(RunRcme({"run", study_, "--trials", "1000", "--out", before}).exit_code, 0);
  const ProgramResult same =
      RunRcme({"gate", before, "--old", "ours", "--of", kWithoutTime, "--out", folder_.Path("same")});
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  const std::string hasty = Estimator("hasty", "num_iterations: 1");
  const ProgramResult other = RunRcme({"gate", before, "--old", "standard", "--new", hasty, "--of",
                                       kWithoutTime, "--out", folder_.Path("other")});
  EXPECT_EQ(other.exit_code, 1) << other.out << other.err;
  EXPECT_THAT(other.out, HasSubstr("; rcme show " + before));
  const ProgramResult files =
      RunRcme({"gate", before, folder_.Path("other/trials.sqlite"), "--old", "standard"});
  EXPECT_EQ(files.exit_code, 1) << files.out << files.err;
  const ProgramResult compared = RunRcme({"compare", before, folder_.Path("other/trials.sqlite")});
  EXPECT_EQ(compared.exit_code, 0) << compared.err;
  EXPECT_THAT(compared.out, HasSubstr("hasty"));
  ASSERT_EQ(RunRcme({"run", study_, "--seed", "9", "--trials", "10", "--out", after}).exit_code, 0);
  EXPECT_TRUE(IsRefused(RunRcme({"compare", before, after}), {"different problems", "seed"}));
}

TEST_F(Gate, AnyNumberOfThreadsGivesTheSameBytes) {
  const std::string hasty = Estimator("hasty", "num_iterations: 5");
  const auto run = [&](const std::string& threads) {
    const std::string out = folder_.Path("threads");
    const ProgramResult gate =
        RunGate({"--old", "standard", "--new", hasty, "--threads", threads, "--out", out});
    const std::string bytes =
        gate.out + ReadBytes(out + "/gate.json") + ReadBytes(out + "/gate.md") + ReadBytes(out + "/gate.xml");
    std::filesystem::remove_all(out);
    return bytes;
  };
  const std::string one = run("1");
  EXPECT_THAT(one, HasSubstr("hasty"));
  EXPECT_EQ(one, run("2"));
}

// What a run was stopped at is kept, and the same command ends as if it had not been stopped.
TEST_F(Gate, GoesOnWhereItWasStopped) {
  const std::vector<std::string> arguments = {"--old",    "standard", "--new",
                                              "standard", "--margin", "failure=0.004"};
  const auto with_out = [&](const std::string& name) {
    std::vector<std::string> all = {"gate", study_, "--of", kWithoutTime};
    all.insert(all.end(), arguments.begin(), arguments.end());
    all.insert(all.end(), {"--out", folder_.Path(name)});
    return all;
  };
  RunningProgram stopped(RcmeCommand(with_out("stopped")));
  while (!std::filesystem::exists(folder_.Path("stopped/trials.sqlite")) && !stopped.HasEnded()) {
  }
  stopped.Send(SIGINT);
  const ProgramResult first = stopped.Wait();
  EXPECT_TRUE(first.exit_code == 130 || first.exit_code == 0) << first.err;
  const ProgramResult resumed = RunRcme(with_out("stopped")), whole = RunRcme(with_out("whole"));
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(resumed.out, whole.out);
  std::vector<std::string> hurried = with_out("hurried");
  hurried.insert(hurried.end(), {"--max-time", "0.001s"});
  const ProgramResult hurry = RunRcme(hurried);
  EXPECT_TRUE(hurry.exit_code == 3 || hurry.exit_code == 0) << hurry.err;
  hurried.back() = "5m";
  EXPECT_EQ(RunRcme(hurried).out, whole.out);
}

// Margins that are chosen after a look would void the level.
TEST_F(Gate, OtherTermsNeedAnotherFolder) {
  const auto judge = [&](const std::vector<std::string>& terms) {
    std::vector<std::string> all = {"gate",     study_,         "--old", "standard", "--new",
                                    "standard", "--max-trials", "30",    "--out",    folder_.Path("terms")};
    all.insert(all.end(), terms.begin(), terms.end());
    return RunRcme(all);
  };
  const std::string failure = "--of=failure", margin = "--margin=failure=0.05";
  const ProgramResult first = judge({failure});
  EXPECT_EQ(first.exit_code, 3) << first.out << first.err;
  EXPECT_THAT(first.out, HasSubstr("not judged: refusal,"));
  EXPECT_TRUE(IsRefused(judge({failure, margin}), {"failure=0.005", "failure=0.05", "another --out"}));
  EXPECT_TRUE(IsRefused(judge({"--of=failure,refusal"}), {"refusal=0.005", "another --out"}));
  EXPECT_EQ(judge({failure}).exit_code, 3) << "the same terms go on";
}

TEST_F(Gate, WrongInputIsRefused) {
  const std::string out = folder_.Path("bad");
  EXPECT_TRUE(IsRefused(RunRcme({"gate", study_, "--old", "standard", "--out", out}), {"--new is missing"}));
  EXPECT_TRUE(IsRefused(RunRcme({"gate", study_, "--new", "standard", "--out", out}),
                        {"there is nothing to test", "--failure-at-most"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"gate", study_, "--old", "ours", "--new", "standard"}), {"--out is missing"}));
  EXPECT_TRUE(IsRefused(RunRcme({"gate", study_, "--old", "ours", "--new", "standrad", "--out", out}),
                        {"did you mean 'standard'?"}));
  EXPECT_TRUE(IsRefused(RunGate({"--old", "ours", "--new", "standard", "--out", out, "--margin", "failure"}),
                        {"--margin: failure"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"gate", study_, "--old", "ours", "--new", "ours", "--of", "speed", "--out", out}),
                {"'speed' is not allowed"}));
  EXPECT_TRUE(
      IsRefused(RunRcme({"gate", study_, folder_.Path("none.sqlite")}), {"is not an rcme result file"}));
  ASSERT_EQ(Run({"--out", out_, "--trials", "5"}).exit_code, 0);
  EXPECT_TRUE(IsRefused(RunRcme({"gate", out_, out_}), {"holds several estimators", "standard, ours"}));
  EXPECT_TRUE(IsRefused(RunRcme({"gate", out_, "--old", "ours", "--seed", "2", "--out", out}), {"--seed"}));
}

}  // namespace
}  // namespace rcme
