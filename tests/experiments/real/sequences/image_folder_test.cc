// A folder of images, rendered.
#include <fmt/format.h>

#include <cstdlib>

#include "tests/test_support/dataset_checks.h"
#include "tests/test_support/paths.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

class ImageFolder : public DatasetTest {
 protected:
  ImageFolder()
      : DatasetTest("corridor", [](const std::string& folder) {
          WriteImageFolder(folder, kNumRenderedFrames, FisheyeCamera());
        }) {}
  static DatasetOptions WithCamera(const std::string& folder) {
    const Camera camera = RenderedCamera().camera;
    DatasetOptions options = MakeDatasetOptions(folder, {camera.fx, camera.fy, camera.cx, camera.cy});
    options.lens = LensModel::kFisheye;
    options.distortion = FisheyeCamera().fisheye;
    return options;
  }
};

TEST_F(ImageFolder, GivesTheRenderedMotions) {
  const std::string out = folder_.Path("out");
  const std::vector<PairRow> rows = MakePairsInto(out, ReadImageFolder(WithCamera(Folder())));
  ExpectTheRenderedMotions(rows, out);
  for (const fs::path& file : MatchFilesIn(out))
    EXPECT_FALSE(ReadMatchFile(file.string()).cam2_from_cam1_true.has_value());
}

// The segments that a camera puts before the frame header of a JPEG: which way it was held (6: a quarter
// turn), and a preview of more than 64 KiB.
std::string WithCameraSegments(const std::string& jpeg) {
  using namespace std::string_literals;
  const std::string exif = "Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0"s;
  std::string segments = "\xFF\xE1\0"s;
  segments += static_cast<char>(exif.size() + 2);
  segments += exif;
  for (int i = 0; i < 2; ++i) {
    segments += "\xFF\xE2\xFF\xFF"s;
    segments.append(0xFFFF - 2, 'p');
  }
  return jpeg.substr(0, 2) + segments + jpeg.substr(2);
}

// By Python's OpenCV: the test program does not link the C++ module that reads and writes images.
void WriteJpeg(const std::string& path, const std::vector<std::uint8_t>& grey) {
  const std::string png = path + ".png";
  WriteImage(png, RenderedCamera().camera, grey);
  const std::string command = fmt::format(
      "\"$({}/scripts/find-python)\" -c 'import cv2, sys; cv2.imwrite(sys.argv[2], cv2.imread(sys.argv[1], "
      "0))' "
      "'{}' '{}'",
      SourceFolder(), png, path);
  ASSERT_EQ(std::system(command.c_str()), 0);
  fs::remove(png);
}

TEST_F(ImageFolder, PhotographsOfACameraAreReadAsTheSensorHasThem) {
  const std::string plain = folder_.Path("plain"), camera = folder_.Path("camera");
  fs::create_directories(plain);
  fs::create_directories(camera);
  for (const int i : {0, 2}) {
    const std::string name = "/" + std::to_string(i) + ".jpg";
    WriteJpeg(plain + name, RenderHall(FisheyeCamera(), PoseOnWalk(i)));
    Overwrite(camera + name, WithCameraSegments(ReadBytes(plain + name)));
  }
  for (const std::string& folder : {plain, camera}) {
    const std::vector<Sequence> read = ReadImageFolder(WithCamera(folder));
    EXPECT_EQ(read[0].lens.camera.width, 320);
    DatasetOptions options = WithCamera(folder);
    options.name = "photographs";
    MakePairsInto(folder + "/out", ReadImageFolder(options));
  }
  const std::string file = "/out/photographs_000000_000001.csv";
  EXPECT_GT(ReadMatchFile(plain + file).matches.size(), 100u);
  EXPECT_EQ(ReadBytes(camera + file), ReadBytes(plain + file));
}

// A folder as it is found: photographs of the camera of K, two that were turned by a quarter, a thumbnail.
// Those of the size that K is of make pairs, whichever comes first by name; the others are skipped, each with
// its reason.
TEST_F(ImageFolder, ImagesOfAnotherSizeAreSkippedAndNamed) {
  const std::string mixed = folder_.Path("mixed"), out = folder_.Path("out");
  fs::create_directories(mixed);
  for (const int i : {0, 2, 4})
    WriteImage(mixed + "/" + std::to_string(i) + ".png", RenderedCamera().camera,
               RenderHall(FisheyeCamera(), PoseOnWalk(i)));
  const std::vector<std::uint8_t> grey(320 * 240, 100);
  for (const char* name : {"/00.png", "/1.png"}) WriteImage(mixed + name, {1, 1, 0, 0, 240, 320}, grey);
  WriteImage(mixed + "/3.png", {1, 1, 0, 0, 80, 60}, std::vector<std::uint8_t>(80 * 60));
  const std::vector<Sequence> read = ReadImageFolder(WithCamera(mixed));
  EXPECT_EQ(read[0].lens.camera.width, 320);
  EXPECT_EQ(read[0].lens.camera.height, 240);
  int num_kept = 0;
  for (const PairRow& row : MakePairsInto(out, read)) {
    num_kept += row.reason == kKeptPair;
    EXPECT_TRUE(row.image1 == "0.png" || row.image1 == "2.png") << row.image1;
  }
  EXPECT_GE(num_kept, 1);
  const std::string text = ReadBytes(out + "/pairs.txt");
  for (const std::string& said :
       {"skipped: " + mixed + "/00.png: is of 240 x 320 px; K is of images of 320 x 240 px: rotate it back",
        "skipped: " + mixed + "/1.png: is of 240 x 320 px", "skipped: " + mixed + "/3.png: is of 80 x 60 px",
        std::string("put images of another size into their own folder")})
    EXPECT_NE(text.find(said), std::string::npos) << text;
}

TEST_F(ImageFolder, WhatIsBrokenIsNamedByPath) {
  DatasetOptions images = WithCamera(Folder());
  images.distortion.pop_back();
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(images); },
                               {"3 distortion coefficients; radtan has 4, 5 or 8"}));
  images.K.clear();
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(images); }, {"--K: fx fy cx cy"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(WithCamera(folder_.path())); }, {"names 0 images"}));
  EXPECT_TRUE(ThrowsInputError([&] { ReadImageFolder(WithCamera("/nowhere")); }, {"/nowhere: is not there"}));
}

}  // namespace
}  // namespace rcme
