// KITTI odometry, rendered.
#include "tests/test_support/dataset_checks.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

class Kitti : public DatasetTest {
 protected:
  Kitti()
      : DatasetTest("dataset",
                    [](const std::string& folder) { WriteKittiSequence(folder, "04", kNumRenderedFrames); }) {
  }
};

TEST_F(Kitti, GivesTheRenderedMotionsAndTheirTruth) {
  const std::vector<Sequence> read = ReadKitti(MakeDatasetOptions(Folder()));
  ASSERT_EQ(read.size(), 1u);
  EXPECT_EQ(read[0].name, "kitti_04");
  EXPECT_EQ(read[0].frames.size(), 1u * kNumRenderedFrames);
  EXPECT_EQ(read[0].frames[3].time_s, 0.3);
  EXPECT_EQ(read[0].lens.camera.width, 320);
  EXPECT_EQ(read[0].lens.camera.fy, 262.0);
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = MakePairsInto(out, read);
  ExpectTheRenderedMotions(rows, out);
  ExpectTheRenderedTruth(rows, out, 1e-4);
  // The folder is one that studies take.
  const auto scenes = LoadMatchFolder({out, 0.5});
  ASSERT_EQ(scenes.size(), 1u);
  EXPECT_EQ(scenes[0].first, "kitti_04");
  EXPECT_EQ(ReadKitti(MakeDatasetOptions(fs::path(Folder()).parent_path().string())).size(),
            1u);  // above it, as unpacked
  DatasetOptions named = MakeDatasetOptions(Folder());
  named.name = "KITTI/";
  named.max_frames = 3;
  EXPECT_EQ(ReadKitti(named)[0].name, "KITTI/04");
  EXPECT_EQ(ReadKitti(named)[0].frames.size(), 3u);
}

// Files as they are found: edited on Windows, without a newline at the end, without the other cameras.
TEST_F(Kitti, DialectsOfItsFilesAreReadTheSame) {
  const std::string s = "sequences/04/";
  const std::vector<Sequence> expected = ReadKitti(MakeDatasetOptions(Folder()));
  for (const auto& how :
       {Replace(s + "calib.txt", "\n", "\r\n", Where::kAll), Replace(s + "calib.txt", "P0:", "\nP0:\t"),
        Replace(s + "times.txt", "\n", " \r\n", Where::kAll),
        Replace(s + "times.txt", "5.000000e-01\n", "0.5"), Replace("poses/04.txt", "\n", "\r\n", Where::kAll),
        Replace("poses/04.txt", " ", "\t", Where::kAll),
        Replace("poses/04.txt", "\n", " \n\n", Where::kAll)}) {
    const std::string copy = Copy();
    how(copy);
    std::vector<Sequence> read;
    ASSERT_NO_THROW(read = ReadKitti(MakeDatasetOptions(copy)));
    EXPECT_EQ(read[0].lens.camera.fx, expected[0].lens.camera.fx);
    ASSERT_EQ(read[0].frames.size(), expected[0].frames.size());
    EXPECT_EQ(read[0].frames[5].time_s, expected[0].frames[5].time_s);
    EXPECT_EQ(read[0].frames[5].pose_true->center, expected[0].frames[5].pose_true->center);
  }
}

TEST_F(Kitti, WhatIsBrokenIsNamedByPath) {
  const std::string s = "sequences/04/";
  const std::vector<Change> cases = {
      {Remove("sequences"), {"/sequences: is not there; the archives of KITTI"}},
      {Remove(s + "image_0"), {"/sequences/image_0: is not there", "data_odometry_gray.zip"}},
      {Remove(s + "calib.txt"), {s + "calib.txt: is not there", "data_odometry_calib.zip"}},
      {Remove(s + "times.txt"), {s + "times.txt: is not there"}},
      {Remove(s + "image_0/000002.png"), {s + "image_0/000002.png: is not there"}},
      {Remove(s + "image_0/000005.png"), {s + "image_0/000005.png: is not there"}},
      {ShrinkImage(s + "image_0/000003.png"), {s + "image_0/000003.png: is of 160 x 120 px", "320 x 240"}},
      {Replace(s + "calib.txt", "P0: 2.6", "P0: x"), {s + "calib.txt:1: 'x", "is not a finite number"}},
      {Replace(s + "calib.txt", "P0: 2.6", "P0: 0.0"), {s + "calib.txt: P0: fx 0", "are not a camera"}},
      {Replace(s + "calib.txt", "P0:", "P9:"), {s + "calib.txt: has no line 'P0: ...'"}},
      {Replace(s + "calib.txt", "\nP1", " 1\nP1"), {}},  // more numbers than are needed
      {Replace(s + "times.txt", "2.000000e-01", "5.000000e-02"),
       {s + "times.txt: the time of image_0/000002.png", "must grow"}},
      {Replace(s + "times.txt", "5.000000e-01\n", ""),
       {s + "times.txt: has 5 lines, and there is an image image_0/000005.png"}},
      {Replace("poses/04.txt", "1.000000000000e+00", "2"),
       {"poses/04.txt:1: the matrix does not begin with a rotation"}},
      {WriteInstead("poses/04.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n"), {"poses/04.txt: has 1 poses"}},
      {WriteInstead(s + "calib.txt", "P0: 700 1 600 0 0 700 180 0 0 0 1 0\n"), {"P0 is not of the form"}},
      {Replace("poses/04.txt", " ", ""), {"poses/04.txt:1: 11 fields; 12 are needed"}},
  };
  for (const Change& change : cases) {
    const std::string copy = Copy();
    change.how(copy);
    if (change.message.empty()) {
      EXPECT_NO_THROW(ReadKitti(MakeDatasetOptions(copy)));
    } else {
      EXPECT_TRUE(ThrowsInputError([&] { ReadKitti(MakeDatasetOptions(copy)); }, change.message));
    }
  }
  const std::string copy = Copy();
  fs::remove_all(copy + "/poses");
  EXPECT_NE(ReadKitti(MakeDatasetOptions(copy))[0].note.find("poses/04.txt is not there"), std::string::npos);
  DatasetOptions other = MakeDatasetOptions(Folder());
  other.only = {"07"};
  EXPECT_TRUE(ThrowsInputError([&] { ReadKitti(other); }, {"--sequence: '07' is not in", "there are 04"}));
}

}  // namespace
}  // namespace rcme
