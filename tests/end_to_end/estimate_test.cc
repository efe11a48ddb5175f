#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "estimator/geometry/pose.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

const std::string kFountain = SourceFolder() + "/../shared/real/dev/strecha_fountain_000.csv.gz";

nlohmann::json Estimate(const std::string& path, const std::string& estimator,
                        const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"estimate", path, "--estimator", estimator, "--json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = RunRcme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return nlohmann::json::parse(result.out);
}

// R is a rotation, t a direction, pose_cov symmetric and positive definite.
void ExpectWholeMotion(const nlohmann::json& json) {
  ASSERT_EQ(json["R"].size(), 9u);
  ASSERT_EQ(json["t"].size(), 3u);
  ASSERT_EQ(json["pose_cov"].size(), 25u);
  Eigen::Matrix3d R;
  Matrix5d cov;
  for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = json["R"][static_cast<size_t>(i)].get<double>();
  for (int i = 0; i < 25; ++i) cov(i / 5, i % 5) = json["pose_cov"][static_cast<size_t>(i)].get<double>();
  const auto t = json["t"].get<std::vector<double>>();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_GT(R.determinant(), 0.0);
  EXPECT_NEAR(std::hypot(t[0], t[1], t[2]), 1.0, 1e-9);
  EXPECT_LE((cov - cov.transpose()).norm(), 1e-9 * cov.norm());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Matrix5d>(cov).eigenvalues()(0), 0.0);
  EXPECT_TRUE(cov.allFinite());
}

class EstimateTest : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Estimators, EstimateTest, testing::Values("standard", "prcme", "rcme"),
                         [](const auto& name) { return name.param; });

TEST_P(EstimateTest, MatchesWithoutNoise) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + TruePoseHeader() + MatchRows(80));
  const nlohmann::json json = Estimate(path, GetParam());
  ASSERT_EQ(json["status"], "ok") << json;
  EXPECT_EQ(json["estimator"], GetParam());
  ExpectWholeMotion(json);
  EXPECT_EQ(json["num_matches"], 80);
  EXPECT_EQ(json["num_inliers"], 80);
  EXPECT_LT(json["rotation_error_deg"].get<double>(), 1e-6);
  EXPECT_LT(json["direction_error_deg"].get<double>(), 1e-6);
  EXPECT_NEAR(json["t"][0].get<double>(), 0.8, 1e-8);
  EXPECT_NEAR(json["t"][1].get<double>(), 0.6, 1e-8);
  EXPECT_NEAR(json["R"][0].get<double>(), 1.0, 1e-9);
}

TEST_P(EstimateTest, PlainAndPackedGiveTheSameAndSoDoesTheSameSeed) {
  const TempFolder folder;
  const std::string text = MatchHeader() + MatchRows(60);
  const std::string plain = folder.Write("pair.csv", text), packed = folder.Write("pair.csv.gz", Gzip(text));
  const nlohmann::json json = Estimate(plain, GetParam(), {"--seed", "5"});
  EXPECT_EQ(Estimate(plain, GetParam(), {"--seed", "5"}), json);
  EXPECT_EQ(Estimate(packed, GetParam(), {"--seed", "5"}), json);
  EXPECT_FALSE(json.contains("rotation_error_deg")) << "an error without a truth";
}

TEST_P(EstimateTest, ARealPair) {
  if (!std::filesystem::exists(kFountain)) GTEST_SKIP() << "the real pairs are not beside the project";
  const nlohmann::json json = Estimate(kFountain, GetParam());
  EXPECT_EQ(json["num_matches"], 1384);
  if (json["status"] != "ok") {
    EXPECT_TRUE(json["status"] == "no_candidate" || json["status"] == "refinement_diverged") << json;
    EXPECT_FALSE(json["message"].get<std::string>().empty());
    EXPECT_TRUE(json["R"].is_null());
    return;
  }
  ExpectWholeMotion(json);
  EXPECT_GT(json["num_inliers"].get<int>(), 700);
  EXPECT_LT(json["rotation_error_deg"].get<double>(), 1.0);
  EXPECT_LT(json["direction_error_deg"].get<double>(), 1.0);
}

TEST_P(EstimateTest, ForPeople) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  const ProgramResult result = RunRcme({"estimate", path, "--estimator", GetParam()});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* text :
       {"ok", "cam2_from_cam1", "inliers: 60 of 60 matches", "rotation error 0.0000 deg"}) {
    EXPECT_NE(result.out.find(text), std::string::npos) << text << " is missing in: " << result.out;
  }
}

TEST(Estimate, ARefusalIsAnAnswer) {
  // Uniform mismatches: rcme refuses, and says so with exit code 0; a motion out of nothing would be worse.
  const TempFolder folder;
  RandomStream rng({.seed = 1, .purpose = 5});
  std::string rows;
  for (int i = 0; i < 60; ++i) {
    rows += fmt::format("{},{},{},{}\n", rng.Uniform(0, 639), rng.Uniform(0, 479), rng.Uniform(0, 639),
                        rng.Uniform(0, 479));
  }
  const nlohmann::json json = Estimate(folder.Write("pair.csv", MatchHeader() + rows), "rcme");
  EXPECT_EQ(json["status"], "no_candidate") << json;
  EXPECT_TRUE(json["R"].is_null());
  EXPECT_TRUE(json["t"].is_null());
  EXPECT_TRUE(json["pose_cov"].is_null());
  EXPECT_EQ(json["num_matches"], 60);
}

}  // namespace
}  // namespace rcme
