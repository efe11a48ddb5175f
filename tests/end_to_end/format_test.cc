// --format of every command that reports a result: standard output is one table of CSV, or one document of
// JSON with the same rows. Commands whose results take more to make are asked in their own tests.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/result_formats.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/without_python.h"

namespace rcme {
namespace {

class Format : public testing::Test {
 protected:
  Format() {
    const ProgramResult made = RunRcme({"run", study_, "--out", run_, "--trials", "40", "--threads", "1"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
  }

  TempFolder folder_;
  const std::string study_ = folder_.Write("study.yaml", SmallStudyYaml());
  const std::string run_ = folder_.Path("run.sqlite"), out_ = folder_.Path("out");
};

TEST_F(Format, OfWhatReadsARun) {
  ExpectFormatsAgree({"summarize", run_});
  ExpectFormatsAgree({"compare", run_});
  ExpectFormatsAgree({"failures", run_, "--of", "failure_or_refusal"});
  ExpectFormatsAgree({"reliability", run_});
  ExpectFormatsAgree({"check", run_});
  ExpectFormatsAgree({"merge", run_, "--check"});
  ExpectFormatsAgree({"run", study_, "--out", run_, "--trials", "40"});
}

TEST_F(Format, OfADamagedFile) {
  std::string bytes = ReadBytes(run_);
  bytes.replace(bytes.size() - 4096, 4096, 4096, '\0');  // a leaf of the records
  folder_.Write("run.sqlite", bytes);
  ExpectFormatsAgree({"check", run_, "--study", study_}, 2);
}

TEST_F(Format, OfARunToAPrecision) {
  ExpectFormatsAgree(
      {"run", study_, "--out", folder_.Path("until.sqlite"), "--until", "ci=0.4", "--max-trials", "100"});
}

TEST_F(Format, OfWhatRunsAStudy) {
  ExpectFormatsAgree({"rare", study_, "--out", out_, "--particles", "20", "--replicates", "4", "--moves", "1",
                      "--set", "severity=skipped", "--set", "max_direction_error_deg=2"});
  ExpectFormatsAgree({"model-choice", study_, "--out", out_, "--trials", "1"});
  ExpectFormatsAgree({"integrity", study_, "--estimator", "standard", "--trials", "20", "--risk", "0.1"}, 1,
                     "conditions");  // the risk is exceeded
  ExpectFormatsAgree(
      {"solve", study_, "--over", "sigma_px", "--from", "0.5", "--to", "4", "--at", "0.2", "--trials", "120"},
      0, "crossings");
  ExpectFormatsAgree({"map", study_, "--trials", "2", "--out", out_}, 0, "rows",
                     0.05);  // three or four digits
}

// Times differ from call to call.
TEST_F(Format, OfTimes) {
  const std::vector<std::string> command = {
      "budget", study_, "--time-ms", "0.5", "--calls", "1", "--out", folder_.Path("budget.yaml"), "--format"};
  const auto run = [&](const std::string& format) {
    std::vector<std::string> arguments = command;
    arguments.push_back(format);
    return RunRcme(arguments).out;
  };
  const auto json = nlohmann::json::parse(run("json"));
  EXPECT_EQ(json.at("format"), "rcme budget 1");
  ASSERT_EQ(json.at("rows").size(), 2u);
  EXPECT_EQ(json.at("rows").at(0).at("estimator"), "standard");
  EXPECT_EQ(json.at("rows").at(0).at("ms_interval").size(), 2u);
  EXPECT_TRUE(run("csv").starts_with("estimator,effort,ms,ms_lower,ms_upper,note\nstandard,"));
}

TEST_F(Format, OfAnAudit) {
  const WithoutPython without_figures;
  ExpectFormatsAgree({"audit", "--plan", "--only", "sigma_p"});
  ExpectFormatsAgree({"audit", "--only", "sampson.dof_1", "--out", out_});
}

TEST_F(Format, OfAGate) {
  ExpectFormatsAgree({"gate", study_, "--of", "failure", "--old", "standard", "--new", "ours", "--max-trials",
                      "20", "--out", out_},
                     3, "tests");
}

// Of one pair its object, of several a row for each.
TEST_F(Format, OfAnswersToPairs) {
  std::filesystem::create_directory(folder_.Path("pairs"));
  const std::string a = folder_.Write("pairs/a.csv", MatchHeader() + MatchRows(60)),
                    bad = folder_.Write("pairs/b.csv", "no matches");
  ExpectFormatsAgree({"estimate", a, a, "--bounds", "1,5", "--integrity-risk", "0.1"});
  ExpectFormatsAgree({"estimate", folder_.Path("pairs"), "--estimator", "rcme"}, 2);
  const auto one = nlohmann::json::parse(RunRcme({"estimate", a, "--format", "json"}).out);
  EXPECT_EQ(one.at("format"), "rcme estimate 2");
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", a, "--json"}), {"--json"}));
}

// Progress and notes are no part of the result.
TEST_F(Format, LatexAndMarkdownAreTables) {
  const ProgramResult latex = RunRcme({"compare", run_, "--format", "latex"}),
                      markdown = RunRcme({"check", run_, "--format", "markdown"});
  EXPECT_TRUE(latex.out.starts_with("\\begin{tabular}")) << latex.out;
  EXPECT_TRUE(markdown.out.starts_with("| file | state |")) << markdown.out;
  EXPECT_TRUE(
      IsRefused(RunRcme({"check", run_, "--format", "xml"}), {"xml", "table, csv, json, latex, markdown"}));
}

}  // namespace
}  // namespace rcme
