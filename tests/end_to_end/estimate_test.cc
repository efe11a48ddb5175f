#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "estimator/geometry/lens.h"
#include "estimator/geometry/pose.h"
#include "tests/end_to_end/bad_input.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/paths.h"
#include "tests/test_support/run_program.h"

namespace rcme {
namespace {

const std::string kFountain = SourceFolder() + "/../shared/real/dev/strecha_fountain_000.csv.gz";

nlohmann::json Estimate(const std::string& path, const std::string& estimator,
                        const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"estimate", path, "--estimator", estimator, "--format=json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramResult result = RunRcme(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  return nlohmann::json::parse(result.out);
}

// R is a rotation, t a direction, pose_cov symmetric, of rank 5, with nothing along t.
void ExpectWholeMotion(const nlohmann::json& json) {
  ASSERT_EQ(json["R"].size(), 9u);
  ASSERT_EQ(json["t"].size(), 3u);
  ASSERT_EQ(json["pose_cov"].size(), 36u);
  Eigen::Matrix3d R;
  Eigen::Matrix<double, 6, 6> cov;
  for (int i = 0; i < 9; ++i) R(i / 3, i % 3) = json["R"][static_cast<size_t>(i)].get<double>();
  for (int i = 0; i < 36; ++i) cov(i / 6, i % 6) = json["pose_cov"][static_cast<size_t>(i)].get<double>();
  const auto t = json["t"].get<std::vector<double>>();
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_GT(R.determinant(), 0.0);
  EXPECT_NEAR(std::hypot(t[0], t[1], t[2]), 1.0, 1e-9);
  EXPECT_LE((cov - cov.transpose()).norm(), 1e-9 * cov.norm());
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(cov)).eigenvalues();
  EXPECT_NEAR(eigenvalues(0), 0.0, 1e-9 * eigenvalues(5));
  EXPECT_GT(eigenvalues(1), 0.0);
  EXPECT_LT((cov.rightCols<3>() * Eigen::Map<const Eigen::Vector3d>(t.data())).norm(), 1e-9 * cov.norm());
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

// Matches without noise through a lens: --camera undoes it, for one that was another camera's the error is
// large, and the header line says the same.
TEST(EstimateLens, IsUndone) {
  const TempFolder folder;
  const std::string parameters = "600,600,319.5,239.5,-0.3,0.1,0.001,0.002";
  const Lens lens =
      MakeLens({600, 600, 319.5, 239.5, 640, 480}, LensModel::kRadtan, {-0.3, 0.1, 0.001, 0.002}, "");
  std::istringstream ideal(MatchRows(80));
  std::string rows;
  for (std::string line; std::getline(ideal, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream numbers(line);
    Eigen::Vector2d x1, x2;
    numbers >> x1.x() >> x1.y() >> x2.x() >> x2.y();
    const Eigen::Vector2d d1 = ProjectThrough(lens, lens.camera.Ray(x1).head<2>()),
                          d2 = ProjectThrough(lens, lens.camera.Ray(x2).head<2>());
    rows += fmt::format("{} {} {} {}\n", d1.x(), d1.y(), d2.x(), d2.y());
  }
  const std::string bare = folder.Write("bare.txt", TruePoseHeader() + rows);
  const auto error_deg = [](const nlohmann::json& json) { return json["direction_error_deg"].get<double>(); };
  const nlohmann::json undone = Estimate(bare, "rcme_calibrated", {"--camera", "OPENCV," + parameters});
  EXPECT_LT(error_deg(undone), 1e-4) << undone;
  EXPECT_GT(error_deg(Estimate(bare, "rcme_calibrated", {"--K", "600,600,319.5,239.5"})), 0.1);
  std::string words = parameters;
  std::replace(words.begin(), words.end(), ',', ' ');
  const std::string header =
      "# camera1: OPENCV 640 480 " + words + "\n# camera2: OPENCV 640 480 " + words + "\n";
  const std::string named = folder.Write("named.txt", header + TruePoseHeader() + rows);
  EXPECT_EQ(Estimate(named, "rcme_calibrated")["R"], undone["R"]);
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", bare, "--camera", "OPENCV,600,600"}),
                        {"--camera 'OPENCV,600,600': 2 parameters; OPENCV has 8"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", bare, "--camera", "OPENCV," + parameters, "--K", "1,1,0,0"}),
                        {"--K and --camera say the same"}));
  EXPECT_TRUE(IsRefused(RunRcme({"estimate", named, "--camera", "OPENCV," + parameters}),
                        {"camera1: the file has its own intrinsics"}));
}

// From one fit: nothing else changes, the default bounds give the stated probability, narrow ones 1.
TEST(EstimateBounds, AreOfTheSameFit) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + MatchRows(40));
  const std::vector<std::string> asked = {"--bounds", "1,5",      "--bounds",
                                          "3,15",     "--bounds", "0.000001,0.000001"};
  nlohmann::json json = Estimate(path, "rcme_calibrated", asked);
  const nlohmann::json list = json["failure_probabilities"];
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0]["rotation_deg"], 1.0);
  EXPECT_EQ(list[0]["direction_deg"], 5.0);
  EXPECT_GE(list[0]["failure_probability"].get<double>(), list[1]["failure_probability"].get<double>());
  EXPECT_NEAR(list[1]["failure_probability"].get<double>(), json["failure_probability"].get<double>(), 1e-9);
  EXPECT_EQ(list[1]["domain"], json["failure_probability_domain"]);
  EXPECT_EQ(list[2]["domain"], "extrapolated");
  json.erase("failure_probabilities");
  EXPECT_EQ(json, Estimate(path, "rcme_calibrated"));
  const ProgramResult text = RunRcme({"estimate", path, "--bounds", "1,5"});
  EXPECT_THAT(text.out, testing::HasSubstr("(rotation off by more than 1 deg or direction by 5 deg)"));
  const ProgramResult table = RunRcme({"estimate", path, path, "--bounds", "1,5"});
  EXPECT_THAT(table.out, testing::HasSubstr("P(>1,5)"));
}

// A right rotation is used, one of 90 deg is not and the answer is as without it; who takes none says so.
TEST(EstimatePrior, IsUsedContradictedOrNone) {
  const TempFolder folder;
  const std::string sd = "# prior_rotation_sd_deg: 0.5\n", rows = MatchRows(80);
  const auto write = [&](const char* name, const std::string& prior) {
    return folder.Write(name, MatchHeader() + prior + rows);
  };
  const std::string right = write("right.csv", sd + "# prior_rotation_rowmajor: 1 0 0 0 1 0 0 0 1\n"),
                    wrong = write("wrong.csv", sd + "# prior_rotation_rowmajor: 0 -1 0 1 0 0 0 0 1\n"),
                    none = write("none.csv", "");
  const nlohmann::json used = Estimate(right, "rcme_calibrated"), off = Estimate(wrong, "rcme_calibrated"),
                       alone = Estimate(none, "rcme_calibrated"), other = Estimate(right, "standard");
  EXPECT_EQ(used["prior"], "used");
  EXPECT_GT(used["prior_p_value"].get<double>(), 1e-3);
  EXPECT_EQ(used["failure_probability_domain"], "extrapolated");
  EXPECT_EQ(off["prior"], "contradicted");
  EXPECT_LT(off["prior_p_value"].get<double>(), 1e-3);
  EXPECT_EQ(off["R"], alone["R"]);
  EXPECT_EQ(off["pose_cov"], alone["pose_cov"]);
  EXPECT_FALSE(alone.contains("prior"));
  EXPECT_EQ(other["prior"], "none");
  EXPECT_THAT(RunRcme({"estimate", right}).out, testing::HasSubstr("prior      used"));
  EXPECT_THAT(RunRcme({"estimate", wrong}).out, testing::HasSubstr("prior      contradicted"));
}

// Answers and their order are the same for any number of threads; a file that cannot be read is named, and
// the others are answered.
TEST(EstimateMany, DoesNotDependOnThreads) {
  const TempFolder folder;
  std::vector<std::string> arguments = {"estimate", "--format=jsonl", "--threads", "1"};
  for (int i = 0; i < 12; ++i) {
    const std::string name = "pair_" + std::to_string(i) + ".csv";
    arguments.push_back(folder.Write(name, i == 5 ? "no matches" : MatchHeader() + MatchRows(30 + i)));
  }
  const ProgramResult one = RunRcme(arguments);
  EXPECT_EQ(one.exit_code, 2);
  EXPECT_EQ(std::ranges::count(one.out, '\n'), 12);
  EXPECT_THAT(one.err, testing::HasSubstr("pair_5.csv"));
  for (const char* threads : {"2", "8"}) {
    arguments[3] = threads;
    EXPECT_EQ(RunRcme(arguments).out, one.out);
  }
  arguments[1] = "--integrity-risk";
  arguments[2] = "0.5";
  arguments.erase(arguments.begin() + 3);
  const ProgramResult table = RunRcme(arguments);
  EXPECT_THAT(table.out, testing::HasSubstr("levels"));
  EXPECT_THAT(table.out, testing::HasSubstr("probability of at most 0.5 each"));
}

// Nothing else changes; below the stated probability of failure nothing is protected.
TEST(EstimateIntegrity, StatesTheLevelsOfTheRisk) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + MatchRows(40));
  nlohmann::json json = Estimate(path, "rcme_calibrated", {"--integrity-risk", "0.9"});
  const nlohmann::json wide = json["protection_levels"];
  EXPECT_EQ(wide["risk"], 0.9);
  const double cov = json["pose_cov"][0].get<double>() + json["pose_cov"][7].get<double>() +
                     json["pose_cov"][14].get<double>();
  EXPECT_GT(wide["rotation_rad"].get<double>(), 0.0);
  EXPECT_LT(wide["rotation_rad"].get<double>(), std::sqrt(cov));  // its 90 % are exceeded
  json.erase("protection_levels");
  EXPECT_EQ(json, Estimate(path, "rcme_calibrated"));
  const nlohmann::json none = Estimate(path, "rcme_calibrated", {"--integrity-risk", "1e-12"});
  EXPECT_NEAR(none["protection_levels"]["rotation_rad"].get<double>(), 3.14159265, 1e-6);
  EXPECT_NEAR(none["protection_levels"]["direction_rad"].get<double>(), 3.14159265, 1e-6);
  const ProgramResult text = RunRcme({"estimate", path, "--integrity-risk", "0.01"});
  EXPECT_THAT(text.out, testing::HasSubstr("probability of at most 0.01\n"));
  EXPECT_NE(RunRcme({"estimate", path, "--integrity-risk", "0"}).exit_code, 0);
}

TEST(EstimateBounds, AreRefusedWhereTheyAreNone) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + MatchRows(40));
  for (const char* text : {"1", "1,", "0,5", "1,5,9", "1,181", "a,b", ""}) {
    const ProgramResult result = RunRcme({"estimate", path, "--bounds", text});
    EXPECT_NE(result.exit_code, 0) << text;
    EXPECT_THAT(result.err, testing::HasSubstr("--bounds")) << text;
  }
  const ProgramResult other = RunRcme({"estimate", path, "--estimator", "rcme", "--bounds", "1,5"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(other.err, testing::HasSubstr("only rcme_calibrated"));
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
  for (const char* text : {"ok", "cam2_from_cam1", "inliers    60 of 60 matches", "rotation error 0.0000 deg",
                           "stands     left, above", "How sure", "What it rests on"}) {
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
  EXPECT_EQ(json["what_to_try"][0], "more samples: --set num_iterations=2000") << json;
}

// As MatchRows, with normal noise of so many pixels.
std::string NoisyRows(int n, double sigma_px) {
  RandomStream rng({.seed = 1, .purpose = 78});
  std::string rows;
  for (int i = 0; i < n; ++i) {
    const double depth = rng.Uniform(4.0, 12.0);
    const double x = rng.Uniform(100.0, 500.0), y = rng.Uniform(100.0, 350.0);
    const auto noise = [&] { return sigma_px * rng.Normal(); };
    const double x1 = x + noise(), y1 = y + noise();
    const double x2 = x + 480.0 / depth + noise(), y2 = y + 360.0 / depth + noise();
    rows += fmt::format("{},{},{},{}\n", x1, y1, x2, y2);
  }
  return rows;
}

std::string WithBlanks(std::string rows) {
  std::ranges::replace(rows, ',', ' ');
  return rows;
}

std::vector<std::string> SplitLines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Estimate, SaysWhatItRestsOn) {
  const TempFolder folder;
  const std::string path = folder.Write("pair.csv", MatchHeader() + NoisyRows(200, 1.0));
  const nlohmann::json right = Estimate(path, "rcme_calibrated", {"--sigma", "1"})["evidence"];
  EXPECT_NEAR(right["sigma_px"].get<double>(), 1.0, 0.2) << right;
  EXPECT_FALSE(right["noise_disagrees"].get<bool>());
  EXPECT_GT(right["parallax_to_noise"].get<double>(), 20.0);
  EXPECT_LT(right["planar_share"].get<double>(), 0.6);
  EXPECT_GT(right["parallax_share"].get<double>(), 0.7);
  EXPECT_TRUE(
      Estimate(path, "rcme_calibrated", {"--sigma", "0.25"})["evidence"]["noise_disagrees"].get<bool>());
  // Of an estimator that does not state the noise, too.
  const ProgramResult too_large = RunRcme({"estimate", path, "--estimator", "standard", "--sigma", "4"});
  EXPECT_THAT(too_large.out, testing::HasSubstr("where 4 px was assumed"));
  EXPECT_THAT(too_large.out, testing::HasSubstr("--sigma 0."));
  EXPECT_THAT(too_large.out, testing::HasSubstr("not stated by this estimator"));
  // No line is wider than a terminal, but for the estimator's own sentence, the first.
  const std::vector<std::string> lines = SplitLines(RunRcme({"estimate", path}).out);
  for (size_t i = 1; i < lines.size(); ++i) EXPECT_LE(lines[i].size(), 100u) << lines[i];
}

TEST(Estimate, ABareFileWithIntrinsicsIsTheFileWithItsHeader) {
  const TempFolder folder;
  const std::string rows = MatchRows(60);
  const std::string whole = folder.Write("whole.csv", MatchHeader() + rows);
  const std::string bare = folder.Write("bare.txt", WithBlanks(rows));
  const std::vector<std::string> k = {"--K", "600,600,319.5,239.5"};
  const nlohmann::json json = Estimate(whole, "rcme");
  EXPECT_EQ(Estimate(bare, "rcme", k), json);
  EXPECT_EQ(Estimate(bare, "rcme", {"--K", "600,600,319.5,239.5", "--K", "600,600,319.5,239.5"}), json);
  const ProgramResult piped = RunShell(
      "cat '" + bare + "' | \"$RCME\" estimate - --estimator rcme --format json --K 600,600,319.5,239.5");
  EXPECT_EQ(piped.exit_code, 0) << piped.err;
  EXPECT_EQ(nlohmann::json::parse(piped.out), json);
  const auto refuses = [&](const std::vector<std::string>& arguments, const std::string& what) {
    const ProgramResult result = RunRcme(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, testing::HasSubstr(what));
  };
  refuses({"estimate", bare}, "rcme estimate --K");
  refuses({"estimate", whole, "--K", k[1]}, "has its own intrinsics; leave out --K");
  refuses({"estimate", whole, "--camera", "PINHOLE,600,600,319.5,239.5"}, "leave out --camera");
  refuses({"estimate", "-"}, "standard input: is empty");
  for (const char* wrong : {"1,2,3", "1,2,3,4,5", "1,1,x,1", "0,1,1,1", "", "inf,1,1,1", "1 1 1 1"})
    refuses({"estimate", bare, "--K", wrong}, "give fx,fy,cx,cy in px");
  refuses({"estimate", bare, "--K", k[1], "--K", k[1], "--K", k[1]}, "more than twice");
  refuses({"estimate", "-", bare, "--K", k[1]}, "stands alone");
}

TEST(Estimate, AFolderGivesALineForEachFileAndFailsForABadOne) {
  const TempFolder folder;
  std::filesystem::create_directory(folder.Path("pairs"));
  folder.Write("pairs/a.csv", MatchHeader() + TruePoseHeader() + MatchRows(60));
  folder.Write("pairs/b.csv", MatchHeader() + MatchRows(60, 2));
  const ProgramResult good = RunRcme({"estimate", folder.Path("pairs")});
  EXPECT_EQ(good.exit_code, 0) << good.err;
  EXPECT_THAT(good.out, testing::HasSubstr("2 pairs: 2 motions, 0 without one, 0 not read"));

  folder.Write("pairs/c.csv", MatchHeader() + "1,2,3\n");
  folder.Write("pairs/d.csv", MatchHeader() + MatchRows(4));
  const ProgramResult table = RunRcme({"estimate", folder.Path("pairs")});
  EXPECT_EQ(table.exit_code, 2);
  EXPECT_THAT(table.err, testing::HasSubstr("c.csv:5: 3 columns"));
  EXPECT_THAT(table.out, testing::HasSubstr("too_few_matches"));
  EXPECT_THAT(table.out, testing::HasSubstr("4 pairs: 2 motions, 1 without one, 1 not read"));

  const ProgramResult lines =
      RunRcme({"estimate", folder.Path("pairs"), "--format=jsonl", "--estimator", "rcme"});
  EXPECT_EQ(lines.exit_code, 2);
  std::vector<std::string> statuses;
  for (const std::string& line : SplitLines(lines.out))
    statuses.push_back(nlohmann::json::parse(line)["status"]);
  EXPECT_EQ(statuses, (std::vector<std::string>{"ok", "ok", "invalid_input", "too_few_matches"}));
  // Each answer is that of its file alone.
  nlohmann::json alone = Estimate(folder.Path("pairs/b.csv"), "rcme");
  alone["file"] = folder.Path("pairs/b.csv");
  EXPECT_EQ(nlohmann::json::parse(SplitLines(lines.out)[1]), alone);
}

}  // namespace
}  // namespace rcme
