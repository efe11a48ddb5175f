// A wrong truth, found, listed and not scored: `rcme check-truth`, `rcme run`, `rcme paper-table`.
#include <gtest/gtest.h>

#include <string>

#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/result_formats.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

TEST(CheckTruthProgram, APairInDoubtIsListedAndNotScored) {
  const TempFolder pairs, folder;
  const std::string header = "# scene: a\n" + MatchHeader();
  for (const char* name : {"a_000.csv", "a_001.csv"})
    pairs.Write(name, header + TruePoseHeader() + MatchRows(300));
  pairs.Write("a_002.csv",
              header + "# R_rowmajor: 0 0 1 0 1 0 -1 0 0\n# t_unit: 0.8 0.6 0\n" + MatchRows(300));
  const std::string out = folder.Path("checked"), run = folder.Path("run.sqlite");
  ProgramResult result = RunRcme({"check-truth", pairs.path(), "--out", out});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, ReadBytes(out + "/truth_check.txt"));
  EXPECT_NE(result.out.find("The truth of 1 of 3 pairs is in doubt"), std::string::npos) << result.out;
  ExpectFormatsAgree({"check-truth", pairs.path()}, 0, "evidence");
  const std::string list = out + "/truth_in_doubt.csv";
  EXPECT_EQ(ReadBytes(list).rfind("scene,pair_id,p_value\na,a_002,", 0), 0u) << ReadBytes(list);

  const std::string study = folder.Write("study.yaml",
                                         "name: t\ntrials: 1\ndata: {scene: match_files, folder: nowhere}\n"
                                         "estimators: [{name: rcme_calibrated}]\n");
  result = RunRcme({"run", study, "--set", "folder=" + pairs.path(), "--set", "truth_in_doubt=" + list,
                    "--out", run, "--threads", "1"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  result = RunRcme({"summarize", run});
  EXPECT_NE(result.out.find("The truth of 1 of 3 pairs is in doubt"), std::string::npos) << result.out;
  result = RunRcme({"summarize", run, "--raw", "csv"});
  EXPECT_NE(result.out.find(",truth_in_doubt,"), std::string::npos) << result.out;
  result = RunRcme({"paper-table", run, "--bound", "5", "--bound", "10", "--format", "csv"});
  EXPECT_NE(result.out.find("\nrun,a,rcme_calibrated,success_10_deg,rate,1,"), std::string::npos)
      << result.out;
  EXPECT_NE(result.out.find("\nrun,a,,truth_in_doubt,rate,0.33333333,,,3,1,"), std::string::npos)
      << result.out;

  EXPECT_TRUE(IsRefused(RunRcme({"check-truth", pairs.path(), "--bounds", "5"}), {"--bounds", "R,D"}));
  EXPECT_TRUE(IsRefused(RunRcme({"paper-table", run, "--bound", "0"}), {"--bound"}));
}

}  // namespace
}  // namespace rcme
