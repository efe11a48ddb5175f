// EuRoC MAV, rendered.
#include <sstream>

#include "tests/test_support/dataset_checks.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

class Euroc : public DatasetTest {
 protected:
  Euroc()
      : DatasetTest("MH_01_easy", [](const std::string& folder) {
          WriteEurocSequence(folder, kNumRenderedFrames, DistortingCamera());
        }) {}
};

TEST_F(Euroc, GivesTheRenderedMotionsAndTheirTruth) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = MakePairsInto(out, ReadEuroc(MakeDatasetOptions(Folder())));
  EXPECT_EQ(rows.at(0).scene, "MH_01_easy");
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 0.05);  // taken between two samples
  EXPECT_EQ(ReadEuroc(MakeDatasetOptions(fs::path(Folder()).parent_path().string())).size(), 1u);
}

// Files as they are found: edited on Windows, without a newline at the end, with a comma too many,
// calibrations as OpenCV writes them.
TEST_F(Euroc, DialectsOfItsFilesAreReadTheSame) {
  const std::string sensor = "mav0/cam0/sensor.yaml", images = "mav0/cam0/data.csv",
                    truth = "mav0/state_groundtruth_estimate0/data.csv";
  const std::vector<Sequence> expected = ReadEuroc(MakeDatasetOptions(Folder()));
  const auto cut_last_byte = [](const std::string& path) {
    return [=](const std::string& folder) {
      fs::resize_file(folder + "/" + path, fs::file_size(folder + "/" + path) - 1);
    };
  };
  const std::vector<Change> cases = {
      {Replace(sensor, "# General", "%YAML:1.0\n---\n# General"), {}},
      {Replace(sensor, "# General", "%YAML:1.0\n# General"), {}},
      {Replace(sensor, "T_BS:", "T_BS: !!opencv-matrix"), {}},
      {Replace(sensor, "T_BS:\n", "T_BS: !!opencv-matrix\n  dt: d\n"), {}},
      {Replace(sensor, "\n", "\r\n", Where::kAll), {}},
      {Replace(sensor, "radial-tangential", "radtan"), {}},
      {Replace(sensor, "#fu", "# fu\ncamera_id: left"), {}},
      {Replace(images, "#timestamp", "\xEF\xBB\xBF#timestamp"), {}},
      {Replace(images, "\r\n", "\n", Where::kAll), {}},
      {Replace(images, ".png\r\n", ".png, \r\n\r\n", Where::kAll), {}},
      {cut_last_byte(images), {}},
      {Replace(truth, "\n", "\r\n", Where::kAll), {}},
      {Replace(truth, ",0.0\n", ",0.0,\n", Where::kAll), {}},
      {Replace(truth, ",0.0\n", "\n", Where::kAll), {}},  // positions and quaternions alone
      {cut_last_byte(truth), {}}};
  for (size_t i = 0; i < cases.size(); ++i) {
    const std::string copy = Copy();
    cases[i].how(copy);
    std::vector<Sequence> read;
    ASSERT_NO_THROW(read = ReadEuroc(MakeDatasetOptions(copy))) << i;
    EXPECT_EQ(read[0].lens.k, expected[0].lens.k) << i;
    EXPECT_EQ(read[0].lens.camera.cy, expected[0].lens.camera.cy) << i;
    ASSERT_EQ(read[0].frames.size(), expected[0].frames.size()) << i;
    for (size_t k = 0; k < read[0].frames.size(); ++k) {
      EXPECT_EQ(read[0].frames[k].name, expected[0].frames[k].name) << i;
      EXPECT_EQ(read[0].frames[k].pose_true->center, expected[0].frames[k].pose_true->center) << i;
    }
  }
}

TEST_F(Euroc, AnEquidistantLensIsAFisheye) {
  const std::string copy = Copy();
  EXPECT_EQ(ReadEuroc(MakeDatasetOptions(copy))[0].lens.model, LensModel::kRadtan);
  Replace("mav0/cam0/sensor.yaml", "radial-tangential", "equidistant")(copy);
  EXPECT_EQ(ReadEuroc(MakeDatasetOptions(copy))[0].lens.model, LensModel::kFisheye);
}

TEST_F(Euroc, WhatIsBrokenIsNamedByPath) {
  const std::string cam = "mav0/cam0/";
  const std::vector<Change> cases = {
      {Remove("mav0"), {"/mav0: is not there"}},
      {Remove(cam + "sensor.yaml"), {cam + "sensor.yaml: is not there"}},
      {Remove(cam + "data.csv"), {cam + "data.csv: is not there"}},
      {Remove(cam + "data/1403636579813555584.png"), {cam + "data/1403636579813555584.png: is not there"}},
      {ShrinkImage(cam + "data/1403636579813555584.png"), {"is of 160 x 120 px", "as its calibration says"}},
      {Replace(cam + "sensor.yaml", "radial-tangential", "pyramid"),
       {"sensor.yaml", "'pyramid' is not known"}},
      {Replace(cam + "sensor.yaml", "intrinsics: [260", "intrinsics: [nan"),
       {"sensor.yaml", "intrinsics: 'nan'"}},
      {Replace(cam + "sensor.yaml", "intrinsics: [260", "intrinsics: [0"),
       {"sensor.yaml", "are not a camera"}},
      {Replace(cam + "sensor.yaml", "intrinsics", "instrinsics"), {"sensor.yaml", "intrinsics: a list"}},
      {Replace(cam + "sensor.yaml", "T_BS", "T_SB"), {"sensor.yaml", "T_BS: is missing"}},
      {Replace(cam + "sensor.yaml", "data: [", "data: [9, "),
       {"sensor.yaml", "T_BS: does not begin with a rotation"}},
      {Replace(cam + "sensor.yaml", "[", "{["), {"sensor.yaml"}},
      {Replace(cam + "sensor.yaml", "[260", "[fx: 260"), {"sensor.yaml", "intrinsics:"}},
      {WriteInstead(cam + "sensor.yaml", ""), {"sensor.yaml"}},
      {Replace(cam + "sensor.yaml", "resolution: [320", "resolution: [320.5"), {"resolution: whole numbers"}},
      {Replace(cam + "data.csv", "1403636579813555584,", "1403636579763555584,"),
       {cam + "data.csv: the time of", "must grow"}},
      {Replace(cam + "data.csv", ",1403636579813555584.png", ""),
       {cam + "data.csv:3: 1 fields; 2 are needed"}},
      {Replace("mav0/state_groundtruth_estimate0/data.csv", ",0.0\n", ",0.0\n1,0,0,0,1,0,0,0\n"),
       {"data.csv:3: the time is before"}},
      {Replace("mav0/state_groundtruth_estimate0/data.csv", "\n1", "\n1,0,0,0,2,0,0,0\n1"),
       {"data.csv:2: a quaternion of length 2"}},
  };
  for (const Change& change : cases) {
    const std::string copy = Copy();
    change.how(copy);
    EXPECT_TRUE(ThrowsInputError([&] { ReadEuroc(MakeDatasetOptions(copy)); }, change.message));
  }
  const std::string copy = Copy();
  fs::remove_all(copy + "/mav0/state_groundtruth_estimate0");
  EXPECT_NE(ReadEuroc(MakeDatasetOptions(copy))[0].note.find("no truth: "), std::string::npos);
}

// Every 16th row of the truth is 80 ms from the one before, every 24th 120 ms: longer than a pose is taken
// in. The images are at 0, 50, ..., 250 ms, the rows from -3 to 302 ms.
TEST_F(Euroc, TakesNoPosesInGapsOfATenthOfASecond) {
  const std::string truth = "/mav0/state_groundtruth_estimate0/data.csv";
  std::istringstream text(ReadBytes(Folder() + truth));
  std::vector<std::string> rows;
  for (std::string row; std::getline(text, row);) rows.push_back(row + "\n");
  for (const size_t stride : {16, 24}) {
    const std::string copy = Copy();
    std::string thinned = rows[0];
    for (size_t i = 1; i < rows.size(); i += stride) thinned += rows[i];
    Overwrite(copy + truth, thinned + rows.back());
    const std::vector<Frame> frames = ReadEuroc(MakeDatasetOptions(copy))[0].frames;
    ASSERT_EQ(frames.size(), 1u * kNumRenderedFrames);
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(frames[i].pose_true.has_value(), stride == 16) << i;
    EXPECT_TRUE(frames[5].pose_true.has_value());  // 65 ms between the rows about 250 ms
  }
}

}  // namespace
}  // namespace rcme
