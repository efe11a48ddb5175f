// An estimator file on its three ways: into a study, into a run, onto one pair.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/test_support/match_text.h"
#include "tests/test_support/run_program.h"
#include "tests/test_support/small_study.h"

namespace rcme {
namespace {

class EstimatorFile : public testing::Test {
 protected:
  ProgramResult Run(const std::string& study, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", study, "--out", out_, "--threads", "1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return RunRcme(arguments);
  }
  nlohmann::json Estimate(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"estimate", matches_, "--format=json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(result.out);
  }
  std::string Table() { return RunRcme({"summarize", out_, "--format", "csv"}).out; }

  TempFolder folder_;
  std::string study_ = folder_.Write("small.yaml", SmallStudyYaml());
  std::string file_ = folder_.Write(
      "tuned.yaml", "name: rcme\nlabel: tuned\noptions: {reading: rank_aware, mu: 5.25, refinement: none}\n");
  std::string matches_ = folder_.Write("m.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  std::string out_ = folder_.Path("run.sqlite");
};

TEST_F(EstimatorFile, AddedToARunIsTheSameAsListedInTheStudy) {
  const ProgramResult added = Run(study_, {"--add-estimator", file_, "--set", "tuned.num_iterations=30"});
  ASSERT_EQ(added.exit_code, 0) << added.err;
  EXPECT_NE(added.err.find("3 estimators"), std::string::npos) << added.err;
  EXPECT_NE(Table().find("tuned"), std::string::npos) << Table();
  std::string yaml = SmallStudyYaml() + "  - {file: tuned.yaml}\n";
  const ProgramResult listed =
      Run(folder_.Write("listed.yaml", yaml), {"--set", "tuned.num_iterations=30", "--set", "tuned.mu=5.25"});
  EXPECT_EQ(listed.exit_code, 0) << "another study: " << listed.err;
  EXPECT_NE(listed.err.find("(12 were there already)"), std::string::npos) << listed.err;
  // The result file needs the estimator file no longer.
  std::filesystem::remove(file_);
  EXPECT_EQ(RunRcme({"replay", out_, "--condition", "1", "--trial", "3"}).exit_code, 0);
}

TEST_F(EstimatorFile, AnInstalledOneIsFoundByItsLabel) {
  EXPECT_EQ(Estimate({"--estimator", "rcme_predictive_tuned"}), Estimate({"--estimator", "rcme_tuned"}));
}

TEST_F(EstimatorFile, SeveralAreAdded) {
  const std::string other = folder_.Write("other.yaml", "name: prcme\n");
  const ProgramResult result = Run(study_, {"--add-estimator", file_, "--add-estimator", other});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_NE(result.err.find("4 estimators"), std::string::npos) << result.err;
}

TEST_F(EstimatorFile, EstimatesAPairWithItsOptions) {
  nlohmann::json by_file = Estimate({"--estimator-file", file_});
  EXPECT_EQ(by_file["estimator"], "tuned");
  nlohmann::json by_name = Estimate(
      {"--estimator", "rcme", "--set", "reading=rank_aware", "--set", "mu=5.25", "--set", "refinement=none"});
  EXPECT_EQ(by_name["estimator"], "rcme");
  by_name.erase("estimator");
  by_file.erase("estimator");
  EXPECT_EQ(by_file, by_name);
  EXPECT_NE(Estimate({"--estimator", "rcme"})["pose_cov"], by_file["pose_cov"])
      << "the options do not matter";
}

TEST_F(EstimatorFile, SetOverridesItsOptions) {
  // No set of inliers has an entropy of -900 nats.
  EXPECT_EQ(Estimate({"--estimator-file", file_})["status"], "ok");
  EXPECT_EQ(Estimate({"--estimator-file", file_, "--set", "mu=-900"})["status"], "no_candidate");
}

TEST_F(EstimatorFile, ARunIgnoresTheTuneBlock) {
  ASSERT_EQ(Run(study_, {}).exit_code, 0);
  const std::string table = Table();
  const std::string tuned = folder_.Write(
      "tuned_study.yaml", SmallStudyYaml() + "tune: {estimator: ours, options: {mu: [3, 6, 9]}}\n");
  const ProgramResult again = Run(tuned, {});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_NE(again.err.find("(12 were there already)"), std::string::npos) << again.err;
  EXPECT_EQ(Table(), table);
}

}  // namespace
}  // namespace rcme
