// TUM RGB-D, rendered.
#include <sstream>

#include "tests/test_support/dataset_checks.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

class Tum : public DatasetTest {
 protected:
  Tum()
      : DatasetTest("rgbd_dataset_desk", [](const std::string& folder) {
          WriteTumSequence(folder, kNumRenderedFrames, DistortingCamera());
        }) {}
  static DatasetOptions WithCamera(const std::string& folder) {
    const Camera camera = RenderedCamera().camera;
    DatasetOptions options = MakeDatasetOptions(folder, {camera.fx, camera.fy, camera.cx, camera.cy});
    options.lens = LensModel::kRadtan;
    options.distortion = DistortingCamera().radtan;
    return options;
  }
};

TEST_F(Tum, GivesTheRenderedMotionsAndTheirTruth) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = MakePairsInto(out, ReadTum(WithCamera(Folder())));
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 0.05);
  // The camera by the folder's name.
  fs::rename(Copy(), folder_.Path("rgbd_dataset_freiburg2_desk"));
  const std::vector<Sequence> known =
      ReadTum(MakeDatasetOptions(folder_.Path("rgbd_dataset_freiburg2_desk")));
  EXPECT_EQ(known[0].lens.camera.fx, 520.9);
  EXPECT_EQ(known[0].lens.k[4], 0.9172);
}

// As in the data set's own freiburg2_desk: several poses of the same time, of which the first and the last
// are wrong.
TEST_F(Tum, OfATimeThatStandsTwiceNoPoseIsUsed) {
  const std::string copy = Copy();
  std::istringstream rows(ReadBytes(copy + "/groundtruth.txt"));
  std::string text, first_doubled;
  for (std::string row; std::getline(rows, row);) {
    if (row.starts_with("1305031102.2") && first_doubled.empty()) {
      first_doubled = row.substr(0, row.find(' '));
      text += first_doubled + " 9 9 9 0 0 0 1\n" + row + "\n" + first_doubled + " 8 8 8 0 0 0 1\n";
    } else {
      text += row + "\n";
    }
  }
  ASSERT_FALSE(first_doubled.empty());
  Overwrite(copy + "/groundtruth.txt", text);
  const Sequence doubled = ReadTum(WithCamera(copy))[0], plain = ReadTum(WithCamera(Folder()))[0];
  EXPECT_NE(doubled.note.find("groundtruth.txt: 1 times stand there more than once"), std::string::npos);
  EXPECT_EQ(plain.note, "");
  for (size_t i = 0; i < plain.frames.size(); ++i)
    EXPECT_LT((doubled.frames[i].pose_true->center - plain.frames[i].pose_true->center).norm(), 1e-3) << i;
}

TEST_F(Tum, PosesAtBothEndsOfAGap) {
  const std::string copy = Copy();
  const std::vector<Frame> plain = ReadTum(WithCamera(Folder()))[0].frames;
  std::string text;
  for (const double time_s : {plain.front().time_s, plain.back().time_s})
    text += std::to_string(time_s) + " 1 2 3 0 0 0.7106 0.7106\n";  // of length 1.005
  Overwrite(copy + "/groundtruth.txt", text);
  const Sequence gap = ReadTum(WithCamera(copy))[0];
  const std::vector<Frame>& frames = gap.frames;
  EXPECT_NE(gap.note.find(std::to_string(frames.size() - 2) + " of " + std::to_string(frames.size()) +
                          " images have no true pose"),
            std::string::npos)
      << gap.note;
  EXPECT_TRUE(frames.front().pose_true.has_value());
  EXPECT_TRUE(frames.back().pose_true.has_value());
  const Eigen::Matrix3d R = frames.back().pose_true->R_world_from_cam;
  EXPECT_LT((R * R.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  for (size_t i = 1; i + 1 < frames.size(); ++i) EXPECT_FALSE(frames[i].pose_true.has_value()) << i;
}

TEST_F(Tum, WhatIsBrokenIsNamedByPath) {
  const std::vector<Change> cases = {
      {WriteInstead("rgb.txt", "1 rgb/1305031102.175300.png\n"),
       {"rgb.txt: names 1 images; a pair needs two"}},
      {Remove("rgb.txt"), {"/rgb.txt: is not there"}},
      {Remove("rgb/1305031102.175300.png"), {"rgb/1305031102.175300.png: is not there"}},
      {Replace("rgb.txt", "1305031102.208633 ", "1305031102.1 "),
       {"rgb.txt: the time of rgb/1305031102.208633.png", "must grow"}},
      {Replace("groundtruth.txt", "1305031102.1823", "1"), {"groundtruth.txt:5: the time is before"}},
  };
  for (const Change& change : cases) {
    const std::string copy = Copy();
    change.how(copy);
    EXPECT_TRUE(ThrowsInputError([&] { ReadTum(WithCamera(copy)); }, change.message));
  }
  EXPECT_TRUE(ThrowsInputError([&] { ReadTum(MakeDatasetOptions(Folder())); }, {"give --K"}));
}

}  // namespace
}  // namespace rcme
