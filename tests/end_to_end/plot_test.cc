// `rcme plot` as a user runs it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/test_support/match_text.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

using testing::HasSubstr;

constexpr const char* kSummary =
    "study,condition,outlier_ratio,estimator,quantity,kind,value,lower,upper,standard_error,n\n"
    "demo,0,0.1,rcme,failure,rate,0.1,0.05,0.2,,100\n"
    "demo,1,0.2,rcme,failure,rate,0.2,0.1,0.3,,100\n";

TEST(Plot, DrawsAFigureWithTheOptionsOfItsKind) {
  const TempFolder folder;
  const std::string summary = folder.Write("summary.csv", kSummary), out = folder.Path("figure");
  const ProgramResult result = RunRcme(
      {"plot", "failure_rate", summary, "--x", "outlier_ratio", "--quantities", "failure", "--out", out});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, out + ".png\n" + out + ".pdf\n");
  EXPECT_GT(std::filesystem::file_size(out + ".png"), 1000u);
}

TEST(Plot, AKindMayBeCalledAsACommandIs) {
  for (const char* kind : {"audit", "tune", "transfer", "reliability"}) {
    const ProgramResult result = RunRcme({"plot", kind, "no_such_file", "--out", "x"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(std::string(kind) + ".py: ")) << result.err;
  }
}

TEST(Plot, BadInputIsNamedAndEndsWithTwo) {
  const ProgramResult unknown = RunRcme({"plot", "pie_chart", "x.csv"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("'pie_chart' is no kind of figure; give one of: failure_rate, "));
  const ProgramResult missing = RunRcme({"plot", "failure_rate", "no_such.csv", "--x", "a", "--out", "b"});
  EXPECT_EQ(missing.exit_code, 2);
  EXPECT_THAT(missing.err, HasSubstr("no_such.csv"));
}

}  // namespace
}  // namespace rcme
