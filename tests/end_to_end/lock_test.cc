// A study that is locked before its run, as a user does it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/test_support/refusal_of_first.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;

class LockedStudy : public testing::Test {
 protected:
  LockedStudy() {
    const ProgramResult locked = Rcme({"lock", study_});
    EXPECT_EQ(locked.exit_code, 0) << locked.err;
    sha256_ = locked.out.substr(0, 64);
  }

  static std::string Yaml(const std::string& margin = "0.02") {
    return SmallStudyYaml() + "ademp: {aims: a, data: b, estimands: c, methods: d, performance: e}\n" +
           "hypotheses:\n  - {quantity: failure, estimator: ours, against: standard, direction: not_higher, "
           "margin: " +
           margin + "}\n";
  }
  static ProgramResult Rcme(const std::vector<std::string>& command) { return RunRcme(command); }
  ProgramResult Run(std::vector<std::string> more, const std::string& out = "run.sqlite") {
    std::vector<std::string> command = {"run", study_, "--threads", "1", "--out", folder_.Path(out)};
    command.insert(command.end(), more.begin(), more.end());
    return Rcme(command);
  }
  std::string Summary(const std::string& run = "run.sqlite") {
    const ProgramResult result = Rcme({"summarize", folder_.Path(run)});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.out;
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("s.yaml", Yaml()), sha256_;
  std::string other_ = folder_.Write("other.yaml", "name: msac\noptions: {num_iterations: 20}\n");
};

TEST_F(LockedStudy, IsRunAndSaysWhatWasDecidedBefore) {
  EXPECT_THAT(ReadBytes(folder_.Path("s.lock")), HasSubstr("sha256: " + sha256_));
  const ProgramResult run = Run({});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr(sha256_));
  const std::string summary = Summary();
  EXPECT_THAT(summary, HasSubstr("Decided before the run"));
  EXPECT_THAT(summary, HasSubstr(sha256_));
  EXPECT_THAT(summary, HasSubstr("failure of ours is not higher than that of standard by 0.02 or more"));
  EXPECT_THAT(summary, Not(HasSubstr("Decided after")));
  EXPECT_THAT(Rcme({"summarize", folder_.Path("run.sqlite"), "--format", "json"}).out, HasSubstr(sha256_));
  const ProgramResult check = Rcme({"check", folder_.Path("run.sqlite")});
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr(sha256_));
  EXPECT_THAT(check.out, HasSubstr("the run is as it was locked"));
  EXPECT_THAT(Rcme({"lock", study_}).err, HasSubstr("exists already"));
}

TEST_F(LockedStudy, AnotherMarginIsRefused) {
  folder_.Write("s.yaml", Yaml("0.03"));
  const ProgramResult run = Run({});
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_THAT(run.err, HasSubstr("hypotheses.1.margin: 0.03 instead of 0.02"));
  EXPECT_THAT(run.err, HasSubstr("--despite-lock"));
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--trials", "7"}, "trials: 7 instead of 6"},
      {{"--seed", "4"}, "seed: 4 instead of 3"},
      {{"--set", "sigma_px=1"}, "data.sigma_px: 1 instead of 0.5"},
      {{"--until", "ci=0.3"}, "as many as a stopping rule gave"},
      {{"--add-estimator", other_}, "estimator msac: was added"}};
  folder_.Write("s.yaml", Yaml());
  for (const auto& [options, difference] : cases) {
    const ProgramResult changed = Run(options);
    EXPECT_EQ(changed.exit_code, 2) << difference;
    EXPECT_THAT(changed.err, HasSubstr(difference));
  }
}

TEST_F(LockedStudy, AnEstimatorThatWasAddedIsDecidedAfter) {
  const ProgramResult run = Run({"--add-estimator", other_, "--despite-lock", "a reader asked for it"});
  EXPECT_EQ(run.exit_code, 0) << run.err;
  const std::string summary = Summary();
  const size_t before = summary.find("Decided before the run"), after = summary.find("Decided after");
  ASSERT_NE(after, std::string::npos) << summary;
  EXPECT_LT(before, after);
  EXPECT_GT(summary.find("estimator msac: was added"), after);
  EXPECT_THAT(summary, HasSubstr("reason: a reader asked for it"));
  EXPECT_THAT(Rcme({"check", folder_.Path("run.sqlite")}).out, HasSubstr("estimator msac: was added"));
}

// What was decided before a run cannot change while it goes on, nor between its parts.
TEST_F(LockedStudy, ALockStaysWithItsRun) {
  EXPECT_EQ(Run({}).exit_code, 0);
  EXPECT_EQ(Run({}).exit_code, 0) << "continued";
  const std::string free = folder_.Write("free.yaml", Yaml()), run = folder_.Path("run.sqlite");
  const ProgramResult without = Rcme({"run", free, "--out", run});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_THAT(without.err, HasSubstr("without a lock"));
  EXPECT_EQ(Rcme({"run", free, "--lock", folder_.Path("s.lock"), "--out", run}).exit_code, 0);
  const std::string part = folder_.Path("part.sqlite"), merged = folder_.Path("merged.sqlite");
  EXPECT_EQ(Rcme({"run", free, "--out", part}).exit_code, 0);
  const ProgramResult merge = Rcme({"merge", run, part, "--out", merged});
  EXPECT_EQ(merge.exit_code, 2);
  EXPECT_THAT(merge.err, HasSubstr("without a lock"));
  EXPECT_EQ(Run({"--trials", "7", "--despite-lock", "one more"}).exit_code, 0);
  EXPECT_THAT(Summary(), HasSubstr("trials: 7 instead of 6"));
  EXPECT_EQ(Rcme({"merge", run, "--out", merged}).exit_code, 0);
  EXPECT_THAT(Summary("merged.sqlite"), HasSubstr("reason: one more"));
  EXPECT_EQ(Run({"--keep", "counts"}, "counts.sqlite").exit_code, 0);
  EXPECT_THAT(Summary("counts.sqlite"), HasSubstr("open: the file keeps counts"));
  EXPECT_THAT(Rcme({"check", folder_.Path("counts.sqlite")}).out, HasSubstr(sha256_));
}

TEST_F(LockedStudy, GoesWithProblemsThatAreAnsweredElsewhere) {
  const std::string problems = folder_.Path("problems"), answers = folder_.Path("answers.jsonl");
  const ProgramResult exported = Rcme({"export", study_, "--out", problems});
  EXPECT_EQ(exported.exit_code, 0) << exported.err;
  EXPECT_EQ(ReadBytes(problems + "/study.lock"), ReadBytes(folder_.Path("s.lock")));
  folder_.Write("answers.jsonl", RefusalOfFirst(ReadBytes(problems + "/problems.jsonl")));
  const ProgramResult imported = Rcme({"import", answers, "--study", problems + "/study.yaml", "--label",
                                       "mine", "--out", folder_.Path("run.sqlite")});
  EXPECT_EQ(imported.exit_code, 0) << imported.err;
  const std::string summary = Summary();
  EXPECT_THAT(summary, HasSubstr("estimator mine: was added"));
  EXPECT_THAT(summary, HasSubstr("reason: answers were imported: mine"));
}

// A lock beside an installed study would hold for everybody who runs it.
TEST_F(LockedStudy, AnInstalledStudyNeedsAPathForItsLock) {
  const ProgramResult refused = Rcme({"lock", "own_camera"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("is installed for everybody"));
  EXPECT_THAT(refused.err, HasSubstr("copy "));
  EXPECT_THAT(refused.err, HasSubstr("--out"));
  const std::string lock = folder_.Path("mine.lock");
  const ProgramResult locked = Rcme({"lock", "own_camera", "--out", lock});
  EXPECT_EQ(locked.exit_code, 0) << locked.err;
  EXPECT_THAT(locked.err, HasSubstr("rcme run own_camera --lock " + lock));
}

TEST_F(LockedStudy, InputsThatAreWrong) {
  EXPECT_THAT(Rcme({"lock", folder_.Write("bare.yaml", SmallStudyYaml())}).err,
              HasSubstr("'ademp' is missing"));
  EXPECT_THAT(Rcme({"run", folder_.Path("bare.yaml"), "--despite-lock", "x", "--out", folder_.Path("r")}).err,
              HasSubstr("has no lock"));
  std::string lock = ReadBytes(folder_.Path("s.lock"));
  folder_.Write("s.lock", lock.replace(lock.find("0.02"), 4, "0.03"));
  const ProgramResult forged = Run({});
  EXPECT_EQ(forged.exit_code, 2);
  EXPECT_THAT(forged.err, HasSubstr("changed after it was made"));
}

}  // namespace
}  // namespace rcme
