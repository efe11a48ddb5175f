// As bombs_test.cc, of the files that data sets come with.
#include <filesystem>

#include "experiments/real/sequences/colmap_model.h"
#include "experiments/real/sequences/layouts.h"
#include "tests/fuzz/bomb.h"
#include "tests/test_support/gzip.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// Tables of downloads may be packed: 4 kB give millions of rows.
TEST(DatasetBomb, RowsWithoutEnd) {
  constexpr double kMaxMb = 256.0;
  const TempFolder folder;
  std::filesystem::create_directories(folder.Path("kitti/sequences/00/image_0"));
  folder.Write("kitti/sequences/00/calib.txt", "P0: 700 0 600 0 0 700 180 0 0 0 1 0\n");
  folder.Write("kitti/sequences/00/times.txt", Gzip(Repeated("1\n", 2'000'000)));
  DatasetOptions kitti;
  kitti.folder = folder.Path("kitti");
  EXPECT_TRUE(
      IsRefusedWithin(kMaxMb, [&] { ReadKitti(kitti); }, {"times.txt:200001: the file has more rows"}));
  std::filesystem::create_directories(folder.Path("tum"));
  folder.Write("tum/rgb.txt", "1 1.png\n2 2.png\n");
  folder.Write("tum/groundtruth.txt", Gzip(Repeated("1 0 0 0 0 0 0 1\n", 1'100'000)));
  DatasetOptions tum;
  tum.folder = folder.Path("tum");
  tum.K = {500, 500, 320, 240};
  EXPECT_TRUE(
      IsRefusedWithin(kMaxMb, [&] { ReadTum(tum); }, {"groundtruth.txt:1000001: the file has more rows"}));
  std::filesystem::create_directories(folder.Path("model"));
  folder.Write("model/cameras.txt", "1 PINHOLE 640 480 500 500 320 240\n");
  std::string images;
  for (int i = 0; i < 200'001; ++i) images += "1 1 0 0 0 0 0 0 1 " + std::to_string(i) + "\n\n";
  folder.Write("model/images.txt", Gzip(images));
  EXPECT_TRUE(IsRefusedWithin(kMaxMb, [&] { ReadColmapModel(folder.Path("model")); },
                              {"images.txt:400001: more than 200000 images are not read"}));
}

// Counts in files of bytes are not believed.
TEST(DatasetBomb, CountsOfColmapsFiles) {
  const TempFolder folder;
  const std::string huge(8, '\xFF'), one = std::string("\x01") + std::string(7, '\0');
  folder.Write("cameras.bin", huge);
  folder.Write("images.bin", huge);
  EXPECT_TRUE(IsRefusedWithin(16.0, [&] { ReadColmapModel(folder.path()); }, {"cameras.bin: ends early"}));
  folder.Write("cameras.bin", std::string(8, '\0'));
  EXPECT_TRUE(IsRefusedWithin(16.0, [&] { ReadColmapModel(folder.path()); }, {"images.bin: ends early"}));
  std::string name_without_end = one;
  name_without_end += std::string(4 + 56 + 4, '\0');
  name_without_end += Repeated("x", 1 << 20);
  folder.Write("images.bin", name_without_end);
  EXPECT_TRUE(
      IsRefusedWithin(16.0, [&] { ReadColmapModel(folder.path()); }, {"images.bin: an image's name"}));
}

}  // namespace
}  // namespace rcme
