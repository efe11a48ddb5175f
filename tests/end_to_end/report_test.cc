// `rcme compare` and `rcme report` as a user runs them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/run/store/result_store.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class Report : public testing::Test {
 protected:
  Report() {
    const ProgramResult result = RunRcme({"run", study_, "--out", run_, "--threads", "1"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
  }
  void ExpectRefused(const std::vector<std::string>& runs, const std::vector<std::string>& fragments,
                     const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"report"};
    arguments.insert(arguments.end(), runs.begin(), runs.end());
    arguments.insert(arguments.end(), {"--out", page_});
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    for (const std::string& fragment : fragments) EXPECT_THAT(result.err, HasSubstr(fragment));
    EXPECT_THAT(result.err, Not(HasSubstr("internal error")));
    EXPECT_FALSE(std::filesystem::exists(page_)) << "a page was written for " << runs[0];
  }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
  std::string run_ = folder_.Path("run.sqlite"), page_ = folder_.Path("report.html");
};

TEST_F(Report, ShowsEveryRunOnOnePage) {
  const std::string copy = folder_.Path("copy.sqlite");
  std::filesystem::copy_file(run_, copy);
  const ProgramResult result = RunRcme({"report", run_, copy, "--against", "ours", "--out", page_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("done: " + page_));
  const std::string page = ReadBytes(page_);
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  for (const std::string& part :
       {std::string("Run 1: small"), std::string("Run 2: small"), "rcme replay " + run_,
        "rcme replay " + copy, "rcme compare " + copy + " --against ours", std::string("num_iterations: 20"),
        std::string("data:image/svg+xml;base64,"), std::string("12 of 12"), std::string("</html>")}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  // Every rate of the summary, as the command prints it.
  std::istringstream csv(RunRcme({"summarize", run_, "--format", "csv"}).out);
  int num_rates = 0;
  for (std::string line; std::getline(csv, line);) {
    const size_t kind = line.find(",rate,");
    if (kind == std::string::npos) continue;
    const size_t value = kind + std::string(",rate,").size();
    EXPECT_THAT(page, HasSubstr("<td>" + line.substr(value, line.find(',', value) - value) + "</td>"))
        << line;
    ++num_rates;
  }
  EXPECT_GT(num_rates, 20);
  const std::string first = page;
  RunRcme({"report", run_, copy, "--against", "ours", "--out", page_});
  EXPECT_EQ(ReadBytes(page_), first) << "equal runs must give equal bytes";
  EXPECT_EQ(folder_.NumEntries(), 4) << "something was left behind";
}

// Runs whose trials are not independent, or stopped by what they saw: tests and intervals that hold there.
TEST_F(Report, ShowsRepeatedScenesAndRunsThatStopped) {
  const std::string repeated = folder_.Path("repeated.sqlite"), stopped = folder_.Path("stopped.sqlite");
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", study_, "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
  };
  run({"--repeats-per-scene", "3", "--out", repeated});
  run({"--until", "ci=0.5", "--out", stopped});
  const ProgramResult refused = RunRcme({"run", study_, "--out", repeated});
  EXPECT_EQ(refused.exit_code, 2) << "another study";
  EXPECT_THAT(refused.err, HasSubstr("repeats_per_scene"));
  EXPECT_THAT(RunRcme({"summarize", repeated}).out, HasSubstr("Scene and sampler"));
  EXPECT_THAT(RunRcme({"compare", repeated, "--of", "events,errors"}).out, HasSubstr("Scenes are repeated"));
  EXPECT_THAT(RunRcme({"compare", stopped, "--of", "events,errors"}).out, HasSubstr("valid at every look"));
  const ProgramResult result = RunRcme({"report", repeated, stopped, "--out", page_});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const std::string page = ReadBytes(page_);
  for (const char* part :
       {"failure_flips", "anytime-valid 95 % (betting)", "p (betting)", "p (anytime-valid)"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST_F(Report, RefusesWhatIsNoRun) {
  const std::string empty = folder_.Path("empty.sqlite"), damaged = folder_.Path("damaged.sqlite");
  { ResultStore::OpenForRun(empty, MakePlan(SmallStudy())); }
  folder_.Write("damaged.sqlite", ReadBytes(run_).substr(0, 20'000));
  ExpectRefused({folder_.Path("none.sqlite")}, {"none.sqlite", "no such result file"});
  ExpectRefused({run_, empty}, {"empty.sqlite", "holds no trial yet"});
  ExpectRefused({run_, damaged}, {"damaged.sqlite", "damaged"});
  ExpectRefused({study_}, {"small.yaml", "is not an rcme result file"});
  ExpectRefused({run_}, {"run.sqlite", "--against", "'rcme'", "allowed: standard, ours"},
                {"--against", "rcme"});
}

TEST_F(Report, SaysBeforehandThatThePageCannotBeWritten) {
  page_ = folder_.Path("none/report.html");
  ExpectRefused({run_}, {"none/report.html", "does not exist"});
  const ProgramResult folder = RunRcme({"report", run_, "--out", folder_.path()});
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_THAT(folder.err, HasSubstr("is a folder"));
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "this system has no /dev/full";
  const ProgramResult full = RunRcme({"report", run_, "--out", "/dev/full"});
  EXPECT_EQ(full.exit_code, 2);
  EXPECT_THAT(full.err, HasSubstr("No space left"));
}

TEST_F(Report, TheRecipeGivesTheNumbersOfThePage) {
  const auto page_of = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", study_, "--out", run_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    EXPECT_EQ(RunRcme(arguments).exit_code, 0);
    EXPECT_EQ(RunRcme({"report", run_, "--out", page_}).exit_code, 0);
    return ReadBytes(page_);
  };
  const std::string shorter = page_of({"--trials", "4"});
  EXPECT_THAT(shorter, HasSubstr("12 of 12"));
  EXPECT_THAT(shorter, HasSubstr("rcme run small.yaml --trials 6 --out small.sqlite"));
  EXPECT_THAT(page_of({"--trials", "8"}), HasSubstr("rcme run small.yaml --trials 8 --out small.sqlite"));
  const std::string until = "--until ci=0.3 --until-event refusal --max-trials 1000";
  const std::string page = page_of({"--until", "ci=0.3", "--until-event", "refusal", "--max-trials", "1000"});
  EXPECT_THAT(page, HasSubstr("rcme run small.yaml " + until + " --out small.sqlite"));
  EXPECT_THAT(page, HasSubstr("200 of 200"));  // the first look of both conditions
  EXPECT_THAT(RunRcme({"summarize", run_}).out, HasSubstr("200 of 200 trials done"));
  const ProgramResult both = RunRcme({"run", study_, "--out", run_, "--until", "ci=0.3", "--trials", "8"});
  EXPECT_EQ(both.exit_code, 2);
  EXPECT_THAT(both.err, HasSubstr("--trials excludes --until"));
}

TEST_F(Report, AnInfiniteBoundIsANumberOfThePage) {
  const std::string run = folder_.Path("few.sqlite");
  ASSERT_EQ(RunRcme({"run", study_, "--set", "num_matches=6", "--set", "outlier_ratio=0.5", "--out", run})
                .exit_code,
            0);
  ASSERT_THAT(RunRcme({"summarize", run, "--format", "csv"}).out,
              HasSubstr("crb_rotation_deg,mean,inf,,,,6,"));
  const ProgramResult result = RunRcme({"report", run, "--out", page_});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(ReadBytes(page_), HasSubstr("<td>inf</td>"));
}

TEST_F(Report, HostileNamesAreOnlyText) {
  std::string yaml = SmallStudyYaml();
  yaml.replace(yaml.find("small"), 5, "'<script>alert(1)</script>'");
  const std::string run = folder_.Path("hostile.sqlite");
  ASSERT_EQ(RunRcme({"run", folder_.Write("hostile.yaml", yaml), "--out", run}).exit_code, 0);
  ASSERT_EQ(RunRcme({"report", run, "--out", page_}).exit_code, 0);
  EXPECT_THAT(ReadBytes(page_), Not(HasSubstr("<script>alert")));
  EXPECT_THAT(ReadBytes(page_), HasSubstr("&lt;script&gt;alert(1)"));
}

TEST_F(Report, CompareWritesTableAndFileAndNamesABadLabel) {
  const ProgramResult table = RunRcme({"compare", run_});
  EXPECT_EQ(table.exit_code, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("Study small against standard: 12 of 12 trials done"));
  const std::string csv = folder_.Path("comparison.csv");
  EXPECT_EQ(RunRcme({"compare", run_, "--format", "csv", "--out", csv}).exit_code, 0);
  EXPECT_THAT(ReadBytes(csv), StartsWith("study,condition,outlier_ratio,estimator,reference,event,n,"));
  const ProgramResult bad = RunRcme({"compare", run_, "--against", "rcme"});
  EXPECT_EQ(bad.exit_code, 2);
  EXPECT_THAT(bad.err, HasSubstr("allowed: standard, ours"));

  std::string yaml = SmallStudyYaml();
  yaml.erase(yaml.find("  - {name: rcme"));
  const std::string alone = folder_.Path("alone.sqlite");
  ASSERT_EQ(RunRcme({"run", folder_.Write("alone.yaml", yaml), "--out", alone}).exit_code, 0);
  const ProgramResult one = RunRcme({"compare", alone});
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_THAT(one.err, HasSubstr("a comparison needs two"));
  EXPECT_EQ(RunRcme({"report", alone, "--out", page_}).exit_code, 0);
}

}  // namespace
}  // namespace rcme
