#include "experiments/data/calibration_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "experiments/data/make_data.h"
#include "experiments/study/study_plan.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/small_study.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Two cameras that differ in every number.
constexpr const char* kTwoCameras =
    "# size1: 848 480\n# size2: 1280 720\n# K1_fx_fy_cx_cy: 520.25 521 423.5 239\n"
    "# K2_fx_fy_cx_cy: 900 905.5 650 350.125\n";

class CalibrationFile : public testing::Test {
 protected:
  std::string Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.Path(name)) << text;
    return folder_.Path(name);
  }
  static Settings From(const std::string& path) {
    return {{"scene", "uniform_volume"}, {"cameras", "from_file"}, {"calibration", path}};
  }
  Study StudyFrom(const std::string& path) {
    Study study = SmallStudy();
    study.data.emplace_back("cameras", "from_file");
    study.data.emplace_back("calibration", path);
    return study;
  }
  TempFolder folder_;
};

void ExpectCamera(const Camera& camera, const Camera& expected) {
  EXPECT_EQ(camera.fx, expected.fx);
  EXPECT_EQ(camera.fy, expected.fy);
  EXPECT_EQ(camera.cx, expected.cx);
  EXPECT_EQ(camera.cy, expected.cy);
  EXPECT_EQ(camera.width, expected.width);
  EXPECT_EQ(camera.height, expected.height);
}

// Catches a swap of the cameras, of fx and fy, of cx and cy, of width and height, and a lost digit.
TEST_F(CalibrationFile, GivesEveryIntrinsicOfBothCameras) {
  const auto data = MakeSimulatedData(From(Write("pair.csv", kTwoCameras)));
  const Scene scene = data->DrawScene({.seed = 1});
  ExpectCamera(scene.camera1, {520.25, 521.0, 423.5, 239.0, 848, 480});
  ExpectCamera(scene.camera2, {900.0, 905.5, 650.0, 350.125, 1280, 720});
  for (const Eigen::Vector3d& point : scene.points_in_cam1) ASSERT_TRUE(scene.Sees(point));
}

TEST_F(CalibrationFile, AMatchFileWillDo) {
  std::string with_matches = kTwoCameras;
  with_matches += "x1,y1,x2,y2\n1,2,3,4\n";
  const std::string path = Write("pair.csv", with_matches);
  EXPECT_EQ(WithCalibration(From(path)), WithCalibration(From(Write("no matches.csv", kTwoCameras))));
}

// What the file says, not where it lies, makes a study.
TEST_F(CalibrationFile, ContentsAreTheIdentityOfAStudyNotThePath) {
  const StudyPlan plan = MakePlan(StudyFrom(Write("a.csv", kTwoCameras)));
  const StudyPlan moved = MakePlan(StudyFrom(Write("b.csv", kTwoCameras)));
  std::string other = kTwoCameras;
  other.replace(other.find("350.125"), 7, "350.126");
  const StudyPlan changed = MakePlan(StudyFrom(Write("c.csv", other)));
  EXPECT_EQ(plan.identity, moved.identity);
  EXPECT_EQ(plan.study_yaml, moved.study_yaml);
  EXPECT_NE(plan.identity, changed.identity);
  EXPECT_EQ(plan.study_yaml.find("a.csv"), std::string::npos) << "a result file needs no other file";
}

// With a factor that chooses a part of the simulation too, whose settings are not all written out.
TEST_F(CalibrationFile, ContentsAreTheIdentityBesideAChoiceAsFactor) {
  Study study = StudyFrom(Write("a.csv", kTwoCameras));
  study.factors.push_back({"motion", {"general", "sideways"}});
  const StudyPlan plan = MakePlan(study);
  study = StudyFrom(Write("b.csv", kTwoCameras));
  study.factors.push_back({"motion", {"general", "sideways"}});
  EXPECT_EQ(plan.identity, MakePlan(study).identity);
  EXPECT_EQ(plan.study_yaml.find("a.csv"), std::string::npos);
}

TEST_F(CalibrationFile, ErrorsNameFileLineAndKey) {
  const auto refuses = [&](const std::string& text, const std::vector<std::string>& words) {
    const std::string path = Write("bad.csv", text);
    return ThrowsInputError([&] { MakeSimulatedData(From(path)); }, words);
  };
  EXPECT_TRUE(refuses("# size1: 848 480\n", {"bad.csv", "K1_fx_fy_cx_cy", "missing"}));
  EXPECT_TRUE(
      refuses("# size1: 848 480\n# size2: 9 9\n# K1_fx_fy_cx_cy: 1 2 3\n", {"bad.csv:3", "K1_fx_fy_cx_cy"}));
  EXPECT_TRUE(
      refuses("# size1: 8 480\n# size2: 8 480\n# K1_fx_fy_cx_cy: 520 520 3.5 239\n# K2_fx_fy_cx_cy: 520 520 "
              "3.5 239\n",
              {"bad.csv", "image1_width", "'8'", "[16, 100000]"}));
  EXPECT_TRUE(ThrowsInputError([&] { MakeSimulatedData(From(folder_.Path("none"))); }, {"none"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        MakeSimulatedData({{"scene", "plane"}, {"cameras", "from_file"}});
      },
      {"calibration", "size1"}));
  EXPECT_TRUE(ThrowsInputError(
      [&] {
        MakeSimulatedData({{"scene", "plane"}, {"calibration", "a"}});
      },
      {"unknown key 'calibration'"}));
  Study study = SmallStudy();
  study.factors.push_back({"calibration", {"a", "b"}});
  EXPECT_TRUE(ThrowsInputError([&] { MakePlan(study); }, {"factors: calibration cannot vary"}));
}

TEST(OwnIntrinsics, EveryNumberIsThatOfItsCamera) {
  const auto data = MakeSimulatedData({{"scene", "uniform_volume"},
                                       {"cameras", "own_intrinsics"},
                                       {"fx1_px", "520"},
                                       {"cy1_px", "200.5"},
                                       {"image1_width", "848"},
                                       {"fy2_px", "610"},
                                       {"cx2_px", "300"}});
  const Scene scene = data->DrawScene({.seed = 1});
  ExpectCamera(scene.camera1, {520.0, 700.0, 423.5, 200.5, 848, 480});
  ExpectCamera(scene.camera2, {700.0, 610.0, 300.0, 239.5, 640, 480});
}

}  // namespace
}  // namespace rcme
