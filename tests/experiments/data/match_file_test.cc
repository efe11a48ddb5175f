#include "experiments/data/match_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "estimator/undistortion.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/match_text.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// A small file with everything in it; `replace` puts one piece of text in place of another.
std::string FullText() {
  return "# pair_id: a_000\n"
         "# scene: a\n"
         "# size1: 640 480\n"
         "# size2: 800 600\n"
         "# K1_fx_fy_cx_cy: 600 610 320 240\n"
         "# K2_fx_fy_cx_cy: 700 710 400 300\n"
         "# R_rowmajor: 0 -1 0 1 0 0 0 0 1\n"
         "# t_unit: 0 0.6 -0.8\n"
         "# a comment without a key\n"
         "x1,y1,x2,y2,ratio\n"
         "14.5,496.25,192.5,795.125,0.7\n"
         "-0.5,1e2,0,3\n";
}

std::string Edited(const std::string& from, const std::string& to) {
  std::string text = FullText();
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

void ExpectFull(const MatchFile& file) {
  EXPECT_EQ(file.scene, "a");
  EXPECT_EQ(file.camera1.width, 640);
  EXPECT_EQ(file.camera1.height, 480);
  EXPECT_EQ(file.camera2.width, 800);
  EXPECT_EQ(file.camera2.height, 600);
  EXPECT_EQ(file.camera1.fx, 600.0);
  EXPECT_EQ(file.camera1.fy, 610.0);
  EXPECT_EQ(file.camera1.cx, 320.0);
  EXPECT_EQ(file.camera1.cy, 240.0);
  EXPECT_EQ(file.camera2.fx, 700.0);
  EXPECT_EQ(file.camera2.cy, 300.0);
  ASSERT_TRUE(file.cam2_from_cam1_true.has_value());
  EXPECT_EQ(file.cam2_from_cam1_true->R(0, 1), -1.0);  // row-major
  EXPECT_EQ(file.cam2_from_cam1_true->R(1, 0), 1.0);
  EXPECT_DOUBLE_EQ(file.cam2_from_cam1_true->t.z(), -0.8);
  ASSERT_EQ(file.matches.size(), 2u);
  EXPECT_EQ(file.matches[0].x1_px, Eigen::Vector2d(14.5, 496.25));
  EXPECT_EQ(file.matches[0].x2_px, Eigen::Vector2d(192.5, 795.125));
  EXPECT_EQ(file.matches[1].x1_px, Eigen::Vector2d(-0.5, 100.0));
  EXPECT_EQ(file.matches[1].x2_px, Eigen::Vector2d(0.0, 3.0));
}

class MatchFileTest : public testing::Test {
 protected:
  MatchFile Read(const std::string& bytes, const std::string& name = "pair.csv") {
    return ReadMatchFile(folder_.Write(name, bytes));
  }
  testing::AssertionResult Refuses(const std::string& bytes, std::vector<std::string> fragments) {
    const std::string path = folder_.Write("bad.csv", bytes);
    fragments.push_back(path);
    return ThrowsInputError([&] { ReadMatchFile(path); }, fragments);
  }

  TempFolder folder_;
};

TEST_F(MatchFileTest, Plain) { ExpectFull(Read(FullText())); }

TEST_F(MatchFileTest, Gzip) {
  ExpectFull(Read(Gzip(FullText()), "pair.csv.gz"));
  ExpectFull(Read(Gzip(FullText()), "misnamed.csv"));  // the bytes decide, not the name
  ExpectFull(Read(FullText(), "also_misnamed.csv.gz"));
}

TEST_F(MatchFileTest, WindowsLineEndsBlankLinesAndNoLastLineEnd) {
  std::string text;
  for (const char c : FullText()) text += c == '\n' ? std::string("\r\n\r\n") : std::string(1, c);
  ExpectFull(Read(text));
  text = FullText();
  text.pop_back();
  ExpectFull(Read(text));
}

TEST_F(MatchFileTest, SpacesAndExtraColumns) {
  ExpectFull(Read(Edited("14.5,496.25,192.5,795.125,0.7", " 14.5 , 496.25,192.5,\t795.125,0.7,more,,nan")));
  ExpectFull(Read(Edited("# size1: 640 480", "#size1:640    480  ")));
}

TEST_F(MatchFileTest, ByteOrderMark) { ExpectFull(Read("\xEF\xBB\xBF" + FullText())); }

TEST_F(MatchFileTest, ColumnNames) {
  for (const char* names : {"x1,y1,x2,y2", " x1 ,\ty1, x2,y2 ", "x1,y1,x2,y2,ratio,,scale"}) {
    ExpectFull(Read(Edited("x1,y1,x2,y2,ratio", names)));
  }
}

TEST_F(MatchFileTest, OtherColumnNames) {
  for (const std::string names : {"x1,x2,y1,y2", "y1,x1,y2,x2", "x2,y2,x1,y1", "x1,y1,x2",
                                  "ratio,x1,y1,x2,y2", "x1,hello", "x1;y1,x2,y2"}) {
    EXPECT_TRUE(Refuses(Edited("x1,y1,x2,y2,ratio", names),
                        {":10: column names '" + names + "'", "give x1,y1,x2,y2[,...], before the first"}))
        << names;
  }
  EXPECT_TRUE(Refuses(MatchHeader() + "u1,v1,u2,v2\n" + MatchRows(9),
                      {":5: column names 'u1,v1,u2,v2'", "give x1,y1,x2,y2", "columns: sigma_px, score"}));
  EXPECT_TRUE(Refuses(FullText() + "x1,y1,x2,y2\n", {":13: column names 'x1,y1,x2,y2'", "before the first"}));
  EXPECT_TRUE(Refuses(FullText() + "x1,nonsense\n", {":13: column names 'x1,nonsense'"}));
}

TEST_F(MatchFileTest, WithoutColumnNamesSceneOrTruePose) {
  const MatchFile file = Read(MatchHeader() + "1,2,3,4\n");
  EXPECT_EQ(file.scene, "unnamed");
  EXPECT_FALSE(file.cam2_from_cam1_true.has_value());
  EXPECT_EQ(file.matches.size(), 1u);
}

TEST_F(MatchFileTest, AColumnMayGiveScoresWhereTheHeaderSaysWhichAreBetter) {
  const std::string rows = "x1,y1,x2,y2,score\n1,2,3,4,0.5\n5,6,7,8,-1.25,9\n";
  EXPECT_FALSE(Read(MatchHeader() + rows).better_score.has_value());
  EXPECT_TRUE(Read(MatchHeader() + "x1,y1,x2,y2,score\n1,2,3,4,none\n").scores.empty());  // no score, no key
  for (const auto& [word, better] :
       {std::pair{"lower", BetterScore::kLower}, {"higher", BetterScore::kHigher}}) {
    const std::string header = MatchHeader() + "# better_score: " + word + "\n";
    const MatchFile file = Read(header + rows);
    EXPECT_EQ(file.better_score, better);
    EXPECT_EQ(file.scores, (std::vector<double>{0.5, -1.25}));
    const double sign = better == BetterScore::kHigher ? 1.0 : -1.0;
    EXPECT_EQ(MakeMotionProblem(file, {}).match_quality, (std::vector<double>{0.5 * sign, -1.25 * sign}));
    const std::string copy = folder_.Path("copy.csv");
    WriteMatchFile(file, copy);
    EXPECT_EQ(ReadMatchFile(copy).better_score, better);
    EXPECT_EQ(ReadMatchFile(copy).scores, file.scores);
    for (const char* wrong : {"nan", "inf", "", "high", "1.25 px"}) {
      std::string row = "5,6,7,8,";
      EXPECT_TRUE(Refuses(header + "x1,y1,x2,y2,score\n" + row.append(wrong) + "\n",
                          {":7: score: '", "is not a finite number"}))
          << wrong;
    }
    EXPECT_TRUE(Refuses(header + "x1,y1,x2,y2,score\n1,2,3,4\n", {":7: score: ''"}));
    for (const char* names : {"x1,y1,x2,y2,ratio", "x1,y1,x2,y2,score,score"})
      EXPECT_TRUE(
          Refuses(header + names + "\n1,2,3,4,5,6\n", {":5: better_score: needs one column named score"}))
          << names;
  }
  EXPECT_TRUE(Refuses(MatchHeader() + "# better_score: best\n" + rows,
                      {":5: better_score: 'best' is not allowed; lower or higher is"}));
}

TEST_F(MatchFileTest, AColumnMayGiveEachMatchItsOwnSigma) {
  EXPECT_TRUE(Read(FullText()).sigma_px.empty());
  const std::string text =
      MatchHeader() + "x1,y1,x2,y2,ratio,sigma_px\n1,2,3,4,nan,0.5\n5,6,7,8,0.1,1.25,9\n";
  const MatchFile file = Read(text);
  EXPECT_EQ(file.sigma_px, (std::vector<double>{0.5, 1.25}));
  const std::string copy = folder_.Path("copy.csv");
  WriteMatchFile(file, copy);
  EXPECT_EQ(ReadMatchFile(copy).sigma_px, file.sigma_px);
  EXPECT_EQ(ReadMatchFile(copy).matches[1].x2_px, file.matches[1].x2_px);
  for (const char* wrong : {"0", "-1", "nan", "inf", "2e6", "", "1.25 px"}) {
    std::string row = "5,6,7,8,0.1,";
    EXPECT_TRUE(Refuses(MatchHeader() + "x1,y1,x2,y2,ratio,sigma_px\n" + row.append(wrong) + "\n",
                        {":6: sigma_px: '", "is not a finite number in (0, 1000000] px"}))
        << wrong;
  }
  EXPECT_TRUE(Refuses(MatchHeader() + "x1,y1,x2,y2,sigma_px\n1,2,3,4\n", {":6: sigma_px: ''"}));
  EXPECT_TRUE(
      Refuses(MatchHeader() + "x1,y1,x2,y2,sigma_px,sigma_px\n", {":5: column sigma_px stands twice"}));
}

// Each over their median; how large they are all together is not passed on.
TEST_F(MatchFileTest, EstimatorsAreToldHowTheSigmasCompare) {
  EXPECT_TRUE(MakeMotionProblem(Read(FullText()), 0.7).noise_scale.empty());
  const std::string rows = MatchHeader() + "x1,y1,x2,y2,sigma_px\n1,2,3,4,0.5\n5,6,7,8,4\n9,1,2,3,2\n";
  const MotionProblem problem = MakeMotionProblem(Read(rows), 0.7);
  EXPECT_EQ(problem.noise_scale, (std::vector<double>{0.25, 2.0, 1.0}));
  EXPECT_EQ(problem.sigma_px, 0.7);
  EXPECT_EQ(problem.matches.size(), 3u);
}

TEST_F(MatchFileTest, NoMatchesIsAnAnswerNotAnError) { EXPECT_TRUE(Read(MatchHeader()).matches.empty()); }

TEST_F(MatchFileTest, TruePoseIsMadeUnitLength) {
  const MatchFile file = Read(Edited("0 0.6 -0.8", "0 0.60003 -0.80004"));
  EXPECT_NEAR(file.cam2_from_cam1_true->t.norm(), 1.0, 1e-15);
}

TEST_F(MatchFileTest, ATemplateMayStateItsNoiseLevel) {
  EXPECT_EQ(Read(FullText()).noise_level, 1.0);
  const std::string line = "# noise_level: 1.5\n";
  const MatchFile file = Read(line + FullText());
  EXPECT_EQ(file.noise_level, 1.5);
  const std::string path = folder_.path() + "/level.csv";
  WriteMatchFile(file, path);
  EXPECT_EQ(ReadMatchFile(path).noise_level, 1.5);
  for (const char* wrong : {"0", "-1", "nan", "1 2", "x"}) {
    std::string text = "# noise_level: ";
    text.append(wrong).append("\n");
    EXPECT_TRUE(Refuses(text + FullText(), {"noise_level"})) << wrong;
  }
}

// The caller's level goes before that of the file, that before the usual one.
TEST_F(MatchFileTest, TheNoiseThatEstimatorsAreToldMayBeStated) {
  EXPECT_EQ(MakeMotionProblem(Read(FullText()), {}).sigma_px, 0.5);
  const MatchFile file = Read("# sigma_px: 2\n" + FullText());
  EXPECT_EQ(MakeMotionProblem(file, {}).sigma_px, 2.0);
  EXPECT_EQ(MakeMotionProblem(file, 0.7).sigma_px, 0.7);
  const std::string path = folder_.Path("copy.csv");
  WriteMatchFile(file, path);
  EXPECT_EQ(ReadMatchFile(path).assumed_sigma_px, 2.0);
  WriteMatchFile(Read(FullText()), path);
  EXPECT_FALSE(ReadMatchFile(path).assumed_sigma_px.has_value());
}

TEST_F(MatchFileTest, AnImpossibleNoiseIsRefused) {
  for (const std::string wrong : {"0", "-1", "nan", "inf", "1 2", "1.5 px", "", "1e-10", "1001"}) {
    EXPECT_TRUE(Refuses("# sigma_px: " + wrong + "\n" + FullText(),
                        {":1: sigma_px: '" + wrong + "' is not allowed; give a number in [1e-09, 1000], px"}))
        << wrong;
  }
  EXPECT_TRUE(Refuses("# sigma_px: 1\n# sigma_px: 1\n" + FullText(), {":2", "'sigma_px' stands twice"}));
}

// The time between the images is kept, and nothing is made up where the file has none.
TEST_F(MatchFileTest, TheTimeBetweenTheImagesMayBeStated) {
  EXPECT_TRUE(std::isnan(Read(FullText()).seconds_between));
  const MatchFile file = Read("# seconds_between: 0.25\n" + FullText());
  EXPECT_EQ(file.seconds_between, 0.25);
  const std::string path = folder_.path() + "/seconds.csv";
  WriteMatchFile(file, path);
  EXPECT_EQ(ReadMatchFile(path).seconds_between, 0.25);
  for (const char* wrong : {"0", "-1", "nan", "1 2", "x"}) {
    std::string text = "# seconds_between: ";
    text.append(wrong).append("\n");
    EXPECT_TRUE(Refuses(text + FullText(), {"seconds_between"})) << wrong;
  }
}

TEST_F(MatchFileTest, TheTruthMayStateItsOwnErrorAndTheImagesTheirNames) {
  EXPECT_FALSE(Read(FullText()).truth_sd.has_value());
  EXPECT_TRUE(std::isnan(Read(FullText()).baseline));
  for (const char* wrong : {"", "-1 m", "0", "nan", "short"}) {
    std::string text = "# baseline: ";
    text.append(wrong).append("\n");
    EXPECT_TRUE(Refuses(text + FullText(), {":1: baseline: ", "give a length > 0"})) << wrong;
  }
  const std::string more =
      "# baseline: 1.25 (m)\n# truth_sd: 0.9 1.8 0 0.01 0.02 0.03\n# image1: a/0001.png\n# image2: "
      "a/0002.png\n";
  const MatchFile file = Read(more + FullText());
  ASSERT_TRUE(file.truth_sd.has_value());
  EXPECT_NEAR(file.truth_sd->rotation_rad.x(), 0.005 * std::numbers::pi, 1e-15);
  EXPECT_NEAR(file.truth_sd->rotation_rad.y(), 0.01 * std::numbers::pi, 1e-15);
  EXPECT_EQ(file.truth_sd->rotation_rad.z(), 0.0);
  EXPECT_EQ(file.truth_sd->translation, Eigen::Vector3d(0.01, 0.02, 0.03));
  EXPECT_EQ(file.image1, "a/0001.png");
  EXPECT_EQ(file.image2, "a/0002.png");
  const std::string path = folder_.path() + "/again.csv";
  WriteMatchFile(file, path);
  const MatchFile again = ReadMatchFile(path);
  ASSERT_TRUE(again.truth_sd.has_value());
  EXPECT_NEAR((again.truth_sd->rotation_rad - file.truth_sd->rotation_rad).norm(), 0.0, 1e-15);
  EXPECT_EQ(again.truth_sd->translation, file.truth_sd->translation);
  EXPECT_EQ(again.image2, file.image2);
  EXPECT_EQ(file.baseline, 1.25);
  EXPECT_EQ(again.baseline, 1.25);
}

TEST_F(MatchFileTest, TruthSdThatCannotBe) {
  EXPECT_TRUE(Refuses("# truth_sd: 1 1 1\n" + FullText(), {":1: truth_sd", "6 are needed"}));
  EXPECT_TRUE(Refuses("# truth_sd: 1 1 1 -1 1 1\n" + FullText(), {":1: truth_sd", ">= 0"}));
  EXPECT_TRUE(Refuses("# truth_sd: 1 1 1 nan 1 1\n" + FullText(), {":1: truth_sd", "'nan'"}));
  EXPECT_TRUE(Refuses("# truth_sd: 1 1 1 1 1 1\n" + MatchHeader(), {":1: truth_sd", "needs a true motion"}));
}

TEST_F(MatchFileTest, SensorsMayStateAPriorOfTheMotion) {
  EXPECT_FALSE(Read(FullText()).prior.has_value());
  const std::string rotation = "# prior_rotation_rowmajor: 0 -1 0 1 0 0 0 0 1\n",
                    gravity = "# gravity1: 0 9.8 0\n# gravity2: -9.8 0 0\n# gravity_sd_deg: 0.9\n",
                    direction = "# prior_direction: 0 3 -4\n# prior_direction_sd_deg: 1.8\n";
  const MatchFile file =
      Read(rotation + "# prior_rotation_sd_deg: 0.9 1.8 3.6\n" + gravity + direction + FullText());
  const auto expect_whole = [](const std::optional<MotionPrior>& prior) {
    ASSERT_TRUE(prior && prior->rotation && prior->gravity && prior->direction);
    EXPECT_EQ(prior->rotation->R(0, 1), -1.0);  // row-major
    const double unit = 0.005 * std::numbers::pi;
    const Eigen::Matrix3d cov = prior->rotation->cov / (unit * unit);
    EXPECT_NEAR((cov - Eigen::Matrix3d(Eigen::Vector3d(1.0, 4.0, 16.0).asDiagonal())).norm(), 0.0, 1e-12);
    EXPECT_EQ(prior->gravity->in_cam1, Eigen::Vector3d::UnitY());
    EXPECT_EQ(prior->gravity->in_cam2, Eigen::Vector3d(-1.0, 0.0, 0.0));
    EXPECT_NEAR(prior->gravity->sd1_rad, unit, 1e-15);
    EXPECT_NEAR(prior->gravity->sd2_rad, unit, 1e-15);
    EXPECT_NEAR((prior->direction->t - Eigen::Vector3d(0.0, 0.6, -0.8)).norm(), 0.0, 1e-15);
    EXPECT_NEAR(prior->direction->sd_rad, 2.0 * unit, 1e-15);
  };
  expect_whole(file.prior);
  expect_whole(MakeMotionProblem(file, 0.5).prior);
  const std::string path = folder_.Path("written.csv");
  WriteMatchFile(file, path);
  expect_whole(ReadMatchFile(path).prior);
  const MatchFile one = Read(rotation + "# prior_rotation_sd_deg: 0.9\n" + FullText());
  ASSERT_TRUE(one.prior && one.prior->rotation);
  EXPECT_FALSE(one.prior->gravity || one.prior->direction);
  EXPECT_EQ(one.prior->rotation->cov(0, 0), one.prior->rotation->cov(2, 2));
}

TEST_F(MatchFileTest, PriorsThatCannotBe) {
  const std::string rotation = "# prior_rotation_rowmajor: 0 -1 0 1 0 0 0 0 1\n";
  EXPECT_TRUE(Refuses(rotation + FullText(), {"prior_rotation_sd_deg", "is missing"}));
  EXPECT_TRUE(
      Refuses("# prior_rotation_sd_deg: 1\n" + FullText(), {"prior_rotation_rowmajor", "is missing"}));
  EXPECT_TRUE(Refuses("# prior_rotation_sd_deg: 1 2\n" + rotation + FullText(),
                      {":1: prior_rotation_sd_deg", "has 2 numbers; give one or three"}));
  EXPECT_TRUE(Refuses("# prior_rotation_sd_deg: 0\n" + rotation + FullText(),
                      {":1: prior_rotation_sd_deg", "[0.0001, 180]"}));
  EXPECT_TRUE(Refuses("# prior_rotation_sd_deg: nan\n" + rotation + FullText(),
                      {":1: prior_rotation_sd_deg", "'nan'"}));
  EXPECT_TRUE(
      Refuses("# prior_rotation_rowmajor: 1 0 0 0 1 0 0 0 -1\n# prior_rotation_sd_deg: 1\n" + FullText(),
              {":1: prior_rotation_rowmajor", "not a rotation"}));
  EXPECT_TRUE(Refuses("# gravity1: 0 1 0\n# gravity_sd_deg: 1\n" + FullText(), {"gravity2", "is missing"}));
  EXPECT_TRUE(Refuses("# gravity1: 0 0 0\n# gravity2: 0 1 0\n# gravity_sd_deg: 1\n" + FullText(),
                      {":1: gravity1", "length"}));
  EXPECT_TRUE(Refuses("# prior_direction: 0 0 1\n" + FullText(), {"prior_direction_sd_deg", "is missing"}));
}

TEST_F(MatchFileTest, DamagedGzip) {
  const std::string whole = Gzip(MatchHeader() + MatchRows(200));
  for (const size_t size : {size_t{3}, size_t{10}, whole.size() / 2, whole.size() - 8, whole.size() - 1}) {
    EXPECT_TRUE(Refuses(whole.substr(0, size), {"damaged or truncated gzip"})) << size << " bytes";
  }
  std::string wrong_sum = whole;
  wrong_sum[wrong_sum.size() - 6] ^= 1;
  EXPECT_TRUE(Refuses(wrong_sum, {"damaged or truncated gzip"}));
}

TEST_F(MatchFileTest, PathsThatAreNoFile) {
  EXPECT_TRUE(
      ThrowsInputError([&] { ReadMatchFile(folder_.Path("none.csv")); }, {"none.csv", "no such match file"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadMatchFile(folder_.path()); }, {folder_.path(), "is a folder"}));
}

TEST_F(MatchFileTest, MissingHeaderKeys) {
  for (const char* key : {"size1", "size2", "K1_fx_fy_cx_cy", "K2_fx_fy_cx_cy"}) {
    EXPECT_TRUE(
        Refuses(Edited(std::string("# ") + key, "# other"), {std::string("'# ") + key, "is missing"}));
  }
  EXPECT_TRUE(Refuses(Edited("# t_unit", "# t"), {"t_unit", "is missing"}));
  EXPECT_TRUE(Refuses(Edited("# R_rowmajor", "# R"), {"R_rowmajor", "is missing"}));
  EXPECT_TRUE(Refuses("\n", {"size1", "is missing", "--K"}));
  EXPECT_TRUE(Refuses(Edited("# size1", "# other"), {"size1", "is missing; add it"}));
  EXPECT_TRUE(Refuses("", {"is empty"}));
}

// The hint about --K helps where the intrinsics are missing, and only there.
TEST_F(MatchFileTest, AMissingKeyOfAPriorIsNotOneOfTheCamera) {
  try {
    Read("# prior_rotation_rowmajor: 0 -1 0 1 0 0 0 0 1\n" + FullText());
    FAIL() << "a prior without its standard deviation was read";
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find("--K"), std::string::npos) << error.what();
  }
}

TEST_F(MatchFileTest, RepeatedHeaderKey) {
  EXPECT_TRUE(Refuses(Edited("# size2: 800 600", "# size1: 640 480"), {":4:", "'size1'", "twice"}));
}

TEST_F(MatchFileTest, BadSizes) {
  for (const char* size : {"0 480", "-640 480", "640.5 480", "1e7 480"}) {
    EXPECT_TRUE(Refuses(Edited("640 480", size), {":3:", "size1", "must be whole numbers in [1, 1e6] px"}))
        << size;
  }
  EXPECT_TRUE(Refuses(Edited("640 480", "640"), {":3:", "size1", "has 1 numbers; 2 are needed"}));
  EXPECT_TRUE(Refuses(Edited("640 480", "640 nan"), {":3:", "size1", "'nan' is not a finite number"}));
}

TEST_F(MatchFileTest, SingularOrMirroredK) {
  EXPECT_TRUE(Refuses(Edited("600 610 320 240", "0 610 320 240"), {":5:", "K1_fx_fy_cx_cy", "singular"}));
  EXPECT_TRUE(Refuses(Edited("700 710 400 300", "700 -710 400 300"), {":6:", "K2_fx_fy_cx_cy", "> 0"}));
  EXPECT_TRUE(Refuses(Edited("600 610 320 240", "600 610 320"), {":5:", "K1_fx_fy_cx_cy", "4 are needed"}));
  EXPECT_TRUE(Refuses(Edited("600 610 320 240", "inf 610 320 240"), {":5:", "'inf' is not a finite number"}));
}

TEST_F(MatchFileTest, MotionsThatAreNone) {
  EXPECT_TRUE(
      Refuses(Edited("0 -1 0 1 0 0 0 0 1", "0 -1 0 1 0 0 0 0 1.1"), {":7:", "R_rowmajor", "not a rotation"}));
  EXPECT_TRUE(
      Refuses(Edited("0 -1 0 1 0 0 0 0 1", "0 1 0 1 0 0 0 0 1"), {":7:", "not a rotation"}));  // det = -1
  EXPECT_TRUE(Refuses(Edited("0 -1 0 1 0 0 0 0 1", "0 -1 0 1 0 0 0 0"), {":7:", "9 are needed"}));
  EXPECT_TRUE(Refuses(Edited("0 0.6 -0.8", "0 0 0"), {":8:", "t_unit", "unit length"}));
  EXPECT_TRUE(Refuses(Edited("0 0.6 -0.8", "0 3 -4"), {":8:", "t_unit", "unit length"}));
}

TEST_F(MatchFileTest, BadRows) {
  for (const char* word : {"nan", "NaN", "inf", "-inf", "1e999", "", "1.2.3", "0x10", "1 2"}) {
    EXPECT_TRUE(Refuses(Edited("192.5", word), {":11: x2", "is not a finite number"})) << word;
  }
  for (const char* word : {"1e308", "-1e308", "1000000.1", "-1000000.1"}) {
    EXPECT_TRUE(Refuses(Edited("192.5", word), {std::string(":11: x2: '") + word + "' is not a finite number",
                                                "in [-1000000, 1000000] px"}));
  }
  EXPECT_EQ(Read(Edited("192.5", "-1e6")).matches[0].x2_px.x(), -1e6);
  EXPECT_TRUE(Refuses(Edited("-0.5,1e2,0,3", "-0.5,1e2,0"), {":12:", "3 columns; x1,y1,x2,y2 are needed"}));
  EXPECT_TRUE(Refuses(Edited("-0.5,1e2,0,3", "hello"), {":12:", "1 columns"}));
  EXPECT_TRUE(Refuses(std::string("\0\1\2\xFF\xFE", 5), {":1:"}));
}

// The same points as a pinhole and a lens see them: reading undoes the lens and says how noisy each is.
TEST_F(MatchFileTest, ALensIsUndone) {
  const Lens radtan =
      MakeLens({600, 610, 319.5, 239.5, 640, 480}, LensModel::kRadtan, {-0.2, 0.05, 1e-3, 0}, "");
  const Lens fisheye = MakeLens({300, 300, 399.5, 299.5, 800, 600}, LensModel::kFisheye, {0.01, 0, 0, 0}, "");
  const std::string header =
      "# camera1: OPENCV 640 480 600 610 319.5 239.5 -0.2 0.05 1e-3 0\n"
      "# camera2: OPENCV_FISHEYE 800 600 300 300 399.5 299.5 0.01 0 0 0\n";
  const std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> rays = {
      {{0.1, 0.2}, {0.3, -0.2}}, {{-0.4, 0.3}, {1.0, 0.5}}, {{0.0, 0.0}, {-0.6, 0.1}}};
  std::string rows;
  for (const auto& [ray1, ray2] : rays) {
    const Eigen::Vector2d x1_px = ProjectThrough(radtan, ray1), x2_px = ProjectThrough(fisheye, ray2);
    rows += fmt::format("{},{},{},{}\n", x1_px.x(), x1_px.y(), x2_px.x(), x2_px.y());
  }
  const MatchFile file = Read("# sigma_px: 0.4\n" + header + rows);
  ASSERT_TRUE(file.undistortion.has_value());
  EXPECT_EQ(file.undistortion->lens2.model, LensModel::kFisheye);
  EXPECT_EQ(file.num_rows, 3U);
  EXPECT_EQ(file.camera1.fy, 610.0);
  EXPECT_EQ(file.camera2.height, 600);
  const MotionProblem problem = MakeMotionProblem(file, {});
  ASSERT_EQ(problem.noise_scale.size(), 3u);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_LT((problem.matches[i].x1_px - radtan.camera.Project(rays[i].first.homogeneous())).norm(), 1e-8);
    EXPECT_LT((problem.matches[i].x2_px - fisheye.camera.Project(rays[i].second.homogeneous())).norm(), 1e-8);
    const Correspondence distorted{ProjectThrough(radtan, rays[i].first),
                                   ProjectThrough(fisheye, rays[i].second)};
    EXPECT_NEAR(problem.sigma_px * problem.noise_scale[i],
                0.4 * UndistortMatch(radtan, fisheye, distorted)->noise_ratio, 1e-9);
  }
  // The same by --camera, with the size of the header and without one.
  const GivenCameras given = CamerasOfOption{{radtan, fisheye}};
  for (const char* sizes : {"", "# size1: 640 480\n# size2: 800 600\n"}) {
    const MatchFile bare = ReadMatchFile(folder_.Write("bare.csv", sizes + rows), given);
    EXPECT_EQ(bare.matches[1].x2_px, file.matches[1].x2_px);
    EXPECT_EQ(bare.sigma_px, file.sigma_px);
    EXPECT_EQ(bare.camera2.width, 800);
  }
  // Written, it is a file of pinhole cameras.
  const std::string copy = folder_.Path("copy.csv");
  WriteMatchFile(file, copy);
  EXPECT_FALSE(ReadMatchFile(copy).undistortion);
  EXPECT_EQ(ReadMatchFile(copy).matches[1].x2_px, file.matches[1].x2_px);
  EXPECT_EQ(ReadMatchFile(copy).sigma_px, file.sigma_px);
  EXPECT_EQ(ReadMatchFile(copy).assumed_sigma_px, problem.sigma_px);
}

TEST_F(MatchFileTest, PinholesByNameAreThoseOfK) {
  const MatchFile file = Read(
      "# camera1: PINHOLE 640 480 600 610 320 240\n# size2: 800 600\n# K2_fx_fy_cx_cy: 700 710 400 300\n"
      "14.5,496.25,192.5,795.125\n");
  EXPECT_FALSE(file.undistortion);
  EXPECT_TRUE(file.sigma_px.empty());
  EXPECT_EQ(file.matches[0].x1_px, Eigen::Vector2d(14.5, 496.25));
  EXPECT_EQ(file.camera1.cx, 320.0);
  EXPECT_EQ(file.camera2.fx, 700.0);
}

TEST_F(MatchFileTest, BadLenses) {
  const auto with = [](const std::string& camera1) {
    return "# camera1: " + camera1 +
           "\n# camera2: PINHOLE 640 480 600 600 319.5 239.5\n1,2,3,4\n320,240,1,2\n";
  };
  EXPECT_TRUE(
      Refuses(with("MAGIC 640 480 600 600 319.5 239.5"), {":1: camera1: ", "'MAGIC' is not supported"}));
  EXPECT_TRUE(Refuses(with("opencv 640 480 600 600 319.5 239.5 0 0 0 0"), {"did you mean 'OPENCV'?"}));
  EXPECT_TRUE(Refuses(with("radtan 640 480 600 600 319.5 239.5 0 0 0 0"),
                      {"FULL_OPENCV, SIMPLE_RADIAL_FISHEYE", "radtan and plumb_bob are OPENCV"}));
  EXPECT_TRUE(Refuses("# camera1: PINHOLE 640 480 600 600 319.5 239.5\n1,2,3,4\n",
                      {"'# camera2: ...' is missing; add it"}));
  EXPECT_TRUE(
      Refuses(with("OPENCV 640 480 600 600 319.5 239.5"), {":1: camera1: ", "4 parameters; OPENCV has 8"}));
  EXPECT_TRUE(
      Refuses(with("PINHOLE 640 480 600 x 319.5 239.5"), {":1: camera1: ", "'x' is not a finite number"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 640.5 480 600 600 319.5 239.5"), {":1: camera1: ", "640.5 x 480 px"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 0 480 600 600 319.5 239.5"), {":1: camera1: ", "0 x 480 px"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 640"), {":1: camera1: ", "give a model, width and height"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 640 480 -600 600 319.5 239.5"), {":1: camera1: ", "fx -600"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 640 480 600 600 319.5 239.5\n# size1: 640 480"),
                      {":2: size1: ", "camera1 says it already"}));
  EXPECT_TRUE(Refuses(with("PINHOLE 640 480 600 600 319.5 239.5\n# K1_fx_fy_cx_cy: 600 600 319.5 239.5"),
                      {":2: K1_fx_fy_cx_cy: ", "camera1 says it already"}));
  const std::string named = folder_.Write("named.csv", with("PINHOLE 640 480 600 600 319.5 239.5"));
  const GivenCameras given =
      CamerasOfOption{{Lens{{600, 600, 319.5, 239.5}}, Lens{{600, 600, 319.5, 239.5}}}, "--camera"};
  EXPECT_TRUE(
      ThrowsInputError([&] { ReadMatchFile(named, given); }, {":1: camera1: ", "leave out --camera"}));
}

// r (1 - r^2) is .385 at most, 231 px: the first row is 398 px from the centre. Its score and sigma go with
// it.
TEST_F(MatchFileTest, AMatchWithoutARayIsLeftOut) {
  const MatchFile file = Read(
      "# camera1: SIMPLE_RADIAL 640 480 600 319.5 239.5 -1\n# camera2: PINHOLE 640 480 600 600 319.5 239.5\n"
      "# better_score: higher\nx1,y1,x2,y2,sigma_px,score\n1,2,3,4,7,0.1\n320,240,1,2,1,0.2\n330,240,1,2,1,0.3\n");
  EXPECT_EQ(file.matches.size(), 2U);
  EXPECT_EQ(file.num_rows, 3U);
  EXPECT_EQ(file.rows, (std::vector<size_t>{1, 2}));
  EXPECT_EQ(file.scores, (std::vector<double>{0.2, 0.3}));
  EXPECT_NEAR(file.sigma_px[0], 1.0, 0.1);
  ASSERT_FALSE(file.doubts.empty());
  EXPECT_THAT(file.doubts.back().place, testing::EndsWith(":5"));
  EXPECT_THAT(file.doubts.back().what, testing::HasSubstr("left out"));
}

// Two gzip files one after the other are one. A damaged beginning of the second loses no match in silence.
TEST_F(MatchFileTest, GzipFilesOfSeveralMembers) {
  const std::string first = Gzip(MatchHeader() + MatchRows(10)), second = Gzip(MatchRows(10));
  EXPECT_EQ(Read(first + second).matches.size(), 20U);
  EXPECT_EQ(Read(first).matches.size(), 10U);
  EXPECT_TRUE(Refuses(first + '\0' + second.substr(1), {"damaged or truncated gzip file"}));
  EXPECT_TRUE(Refuses(first + second.substr(0, 5), {"damaged or truncated gzip file"}));
  EXPECT_TRUE(Refuses(first + "1,2,3,4\n", {"damaged or truncated gzip file"}));
}

// They are read by their first columns, which is said once.
TEST_F(MatchFileTest, RowsOfMoreColumnsThanStated) {
  const auto doubts = [&](const std::string& rows) { return Read(MatchHeader() + rows).doubts; };
  EXPECT_TRUE(doubts("10,20,30,40\n11,20,30,40\n").empty());
  EXPECT_TRUE(doubts("x1,y1,x2,y2,ratio\n10,20,30,40,0.5\n10,20,30,40\n").empty());
  const std::vector<InputDoubt> unnamed = doubts("10,20,30,40\n1,10,20,30,40\n2,10,20,30,40\n");
  ASSERT_EQ(unnamed.size(), 1U);
  EXPECT_THAT(unnamed[0].place, testing::EndsWith(":6"));
  EXPECT_THAT(unnamed[0].what, testing::HasSubstr("columns without names"));
  const std::vector<InputDoubt> named = doubts("x1,y1,x2,y2\n10,20,30,40,50,60,70,80\n");
  ASSERT_EQ(named.size(), 1U);
  EXPECT_THAT(named[0].what, testing::HasSubstr("more columns than there are names"));
  EXPECT_TRUE(Refuses(MatchHeader() + "x1,y1,x2,y2,x1\n1,2,3,4,5\n", {"column x1 stands twice"}));
  EXPECT_TRUE(Refuses(MatchHeader() + "1,2,3\n", {"3 columns; x1,y1,x2,y2 are needed"}));
  const TempFolder slips;
  const auto near = [&](const std::string& line) {
    return ReadMatchFile(slips.Write("slip.csv", line + "\n" + MatchHeader() + "1,2,3,4\n")).doubts;
  };
  ASSERT_EQ(near("# sigma: 0.7").size(), 1U);
  EXPECT_NE(near("# sigma: 0.7")[0].what.find("did you mean 'sigma_px'?"), std::string::npos);
  EXPECT_TRUE(near("# licence: free").empty());
  EXPECT_TRUE(Refuses("PK\x03\x04 and bytes\n", {"is a zip or npz archive", "rcme pairs --layout npz"}));
}

TEST_F(MatchFileTest, WriteRoundTrip) {
  MatchFile file = Read(MatchHeader() + TruePoseHeader() + MatchRows(20));
  file.scene = "somewhere";
  file.camera1.fx = 600.0 + 1.0 / 3.0;
  file.cam2_from_cam1_true->R = RotationFromVector({0.1, -0.2, 0.3});
  file.matches[0].x1_px.x() = 0.1 + 0.2;
  const std::string path = folder_.Path("written.csv");
  WriteMatchFile(file, path);
  const MatchFile again = ReadMatchFile(path);
  EXPECT_EQ(again.scene, file.scene);
  EXPECT_EQ(again.camera1.K(), file.camera1.K());
  EXPECT_EQ(again.camera2.K(), file.camera2.K());
  EXPECT_EQ(again.cam2_from_cam1_true->R, file.cam2_from_cam1_true->R);
  EXPECT_LT((again.cam2_from_cam1_true->t - file.cam2_from_cam1_true->t).norm(), 1e-15);
  ASSERT_EQ(again.matches.size(), file.matches.size());
  for (size_t i = 0; i < file.matches.size(); ++i) {
    EXPECT_EQ(again.matches[i].x1_px, file.matches[i].x1_px);
    EXPECT_EQ(again.matches[i].x2_px, file.matches[i].x2_px);
  }
  WriteMatchFile(again, path);  // over the old one
  EXPECT_EQ(ReadMatchFile(path).matches.size(), 20u);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 2)
      << "left a part file behind";
}

TEST_F(MatchFileTest, WriteErrors) {
  const MatchFile file = Read(FullText());
  EXPECT_TRUE(ThrowsInputError([&] { WriteMatchFile(file, folder_.Path("none/x.csv")); },
                               {"none/x.csv", "cannot be"}));
  EXPECT_TRUE(
      ThrowsInputError([&] { WriteMatchFile(file, folder_.path()); }, {folder_.path(), "cannot be written"}));
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_TRUE(ThrowsInputError([&] { WriteMatchFile(file, "/dev/full"); }, {"/dev/full", "No space left"}));
  }
}

}  // namespace
}  // namespace rcme
