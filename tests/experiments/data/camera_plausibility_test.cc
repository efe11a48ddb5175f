// Which cameras pass without a word, and which mistakes of K are seen.
#include "experiments/data/camera_plausibility.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "experiments/data/match_folder.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/paths.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

struct NamedCamera {
  const char* name;
  Camera camera;
};

// As their data sets, makers' calibrations or papers state them.
const std::vector<NamedCamera>& RealCameras() {
  static const std::vector<NamedCamera> cameras = {
      {"KITTI odometry 00", {718.856, 718.856, 607.1928, 185.2157, 1241, 376}},
      {"KITTI odometry 04", {707.0912, 707.0912, 601.8873, 183.1104, 1226, 370}},
      {"KITTI raw, not rectified", {984.2439, 980.8141, 690.0, 233.1966, 1392, 512}},
      {"EuRoC cam0", {458.654, 457.296, 367.215, 248.375, 752, 480}},
      {"EuRoC cam1", {457.587, 456.134, 379.999, 255.238, 752, 480}},
      {"TUM freiburg1", {517.3, 516.5, 318.6, 255.3, 640, 480}},
      {"TUM freiburg2", {520.9, 521.0, 325.1, 249.7, 640, 480}},
      {"TUM freiburg3", {535.4, 539.2, 320.1, 247.6, 640, 480}},
      {"TUM VI, fisheye of 195 degrees", {190.97847715, 190.97330709, 254.93170605, 256.89744234, 512, 512}},
      {"ETH3D photographs", {3408.59, 3408.87, 3117.24, 2064.07, 6048, 4032}},
      {"ScanNet", {1169.621094, 1167.105103, 646.295044, 489.927032, 1296, 968}},
      {"7-Scenes", {585.0, 585.0, 320.0, 240.0, 640, 480}},
      {"DTU", {2892.33, 2883.18, 823.205, 619.071, 1600, 1200}},
      {"Middlebury temple", {1520.4, 1525.9, 302.32, 246.87, 640, 480}},
      {"Middlebury 2014 Adirondack, left", {4161.221, 4161.221, 1445.577, 984.686, 2880, 1988}},
      {"Middlebury 2014 Adirondack, right", {4161.221, 4161.221, 1654.636, 984.686, 2880, 1988}},
      {"Cityscapes", {2262.52, 2265.3017905988554, 1096.98, 513.137, 2048, 1024}},
      {"nuScenes, front", {1266.417203, 1266.417203, 816.2670197, 491.507066, 1600, 900}},
      {"nuScenes, back",
       {809.2209905677063, 809.2209905677063, 829.2196003259838, 481.77842384512485, 1600, 900}},
      {"a side camera cut to a strip, as Waymo's", {2064.0, 2064.0, 960.0, 250.0, 1920, 886}},
      {"Strecha fountain", {1379.74, 1382.08, 760.35, 503.41, 1536, 1024}},
      {"a phone, 4:3", {3225.6, 3225.6, 2015.5, 1511.5, 4032, 3024}},
      {"a phone, held upright and turned", {1600.0, 1600.0, 539.5, 959.5, 1080, 1920}},
      {"a telephoto lens of 600 mm", {100'000.0, 100'000.0, 2999.5, 1999.5, 6000, 4000}},
      {"a wide lens of 120 degrees, undistorted", {1155.0, 1155.0, 1999.5, 1499.5, 4000, 3000}},
      {"16:9 scaled to 4:3", {466.7, 622.2, 319.5, 239.5, 640, 480}},
      {"anamorphic video", {1440.0, 1080.0, 719.5, 539.5, 1440, 1080}}};
  return cameras;
}

TEST(CameraPlausibility, TheCamerasOfDataSetsPassWithoutAWord) {
  for (const auto& [name, camera] : RealCameras()) {
    std::vector<InputDoubt> doubts;
    ASSERT_NO_THROW(doubts = FindCameraDoubts(camera, "K")) << name;
    EXPECT_TRUE(doubts.empty()) << name << ": " << doubts[0].what;
  }
}

bool IsNoticed(const Camera& camera, const std::string& said) {
  try {
    for (const InputDoubt& doubt : FindCameraDoubts(camera, "K")) {
      if (doubt.what.find(said) != std::string::npos) return true;
    }
  } catch (const InputError& error) {
    return true;
  }
  return false;
}

Camera WithScaledK(Camera camera, double scale) {
  for (double* number : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *number *= scale;
  return camera;
}

// K of the image at other sizes: every one of the cameras above but those whose principal point is far off
// already.
TEST(CameraPlausibility, KOfAnotherSizeIsNoticedWithEveryCamera) {
  for (const auto& [name, camera] : RealCameras()) {
    for (const double scale : {0.25, 0.5, 2.0, 4.0})
      EXPECT_TRUE(IsNoticed(WithScaledK(camera, scale), "")) << name << " at " << scale;
  }
  for (const double scale : {0.5, 2.0 / 3.0, 0.75, 1.25, 1.5}) {
    EXPECT_TRUE(IsNoticed(WithScaledK(RealCameras()[0].camera, scale), "if it was scaled, divide")) << scale;
  }
  const std::vector<InputDoubt> half =
      FindCameraDoubts(WithScaledK({700, 700, 319.5, 239.5, 640, 480}, 0.5), "a: K");
  ASSERT_EQ(half.size(), 1u);
  EXPECT_EQ(half[0].place, "a: K");
  EXPECT_EQ(
      half[0].what,
      "the principal point is the centre of an image of 321 x 240 px, the image has 640 x 480 px; if it was "
      "scaled, divide fx, fy, cx and cy by about 0.50");
}

TEST(CameraPlausibility, NumbersInAnotherOrderAreRefused) {
  const auto refuses = [](const Camera& camera, const std::string& order) {
    return ThrowsInputError([&] { FindCameraDoubts(camera, "--K"); },
                            {"--K: ", "the numbers look like " + order + " and are read as fx fy cx cy"});
  };
  EXPECT_TRUE(refuses({320, 240, 520, 525, 640, 480}, "cx cy fx fy"));
  EXPECT_TRUE(refuses({607.2, 185.2, 718.9, 718.9, 1241, 376}, "cx cy fx fy"));
  EXPECT_TRUE(refuses({960, 540, 1000, 1000, 1920, 1080}, "cx cy fx fy"));
  EXPECT_TRUE(refuses({520, 320, 525, 240, 640, 480}, "fx cx fy cy"));
  EXPECT_TRUE(refuses({320, 520, 240, 525, 640, 480}, "cx fx cy fy"));
  // Of a square image the pixels look square in either order.
  EXPECT_TRUE(refuses({255.5, 255.5, 600, 600, 512, 512}, "cx cy fx fy"));
  EXPECT_TRUE(IsNoticed({255.5, 255.5, 400, 400, 512, 512}, "look like cx cy fx fy"));
}

TEST(CameraPlausibility, OtherMistakes) {
  EXPECT_TRUE(ThrowsInputError(
      [] {
        FindCameraDoubts({800, 800, 641, 240, 640, 480}, "f:3: K1");
      },
      {"f:3: K1: 800 800 641 240: the principal point is outside of the image of 640 x 480"}));
  EXPECT_TRUE(ThrowsInputError([] { FindCameraDoubts({800, 800, 320, -3, 640, 480}, "K"); }, {"is outside"}));
  EXPECT_NO_THROW(FindCameraDoubts({800, 800, 639.4, 240, 640, 480}, "K"));
  // In shares of the width, and in millimetres.
  EXPECT_TRUE(ThrowsInputError(
      [] {
        FindCameraDoubts({0.9, 0.9, 0.5, 0.5, 640, 480}, "K");
      },
      {"not in mm or in shares"}));
  EXPECT_TRUE(ThrowsInputError(
      [] {
        FindCameraDoubts({4.2, 4.2, 2000, 1500, 4000, 3000}, "K");
      },
      {"in px, not in mm"}));
  EXPECT_TRUE(IsNoticed({35, 35, 319.5, 239.5, 640, 480}, "is 85.0 degrees off the axis"));
  EXPECT_TRUE(IsNoticed({50'000, 50'000, 319.5, 239.5, 640, 480}, "shows 0.73 degrees"));
  EXPECT_TRUE(IsNoticed({300, 700, 319.5, 239.5, 640, 480}, "differ by more than a factor of two"));
  EXPECT_TRUE(IsNoticed({600, 600, 319.5, 239.5, 480, 640}, "if it was turned, give K of the turned image"));
  EXPECT_TRUE(
      IsNoticed({600, 600, 500, 239.5, 640, 480}, "the principal point (500, 239.5) is far from the centre"));
}

// Points all over an image of 640 x 480 px.
std::vector<Correspondence> PointsOnAGrid(double width = 640.0, double height = 480.0, double x0 = 0.0) {
  std::vector<Correspondence> matches;
  for (int i = 0; i < 144; ++i) {
    const Eigen::Vector2d x(x0 + width * (i % 12 + 0.5) / 12.0, height * (i / 12 + 0.5) / 12.0);  // NOLINT
    matches.push_back({x, x});
  }
  return matches;
}

std::string SayOfPoints(const Camera& camera, const std::vector<Correspondence>& matches,
                        bool is_size_known) {
  std::string said;
  for (const InputDoubt& d : FindKeyPointDoubts(camera, matches, &Correspondence::x1_px, is_size_known, "K"))
    said += d.what + "\n";
  return said;
}

TEST(CameraPlausibility, KeyPointsStandForASizeThatIsNotKnown) {
  const Camera right{600, 600, 319.5, 239.5, 0, 0};
  EXPECT_EQ(SayOfPoints(right, PointsOnAGrid(), false), "");
  EXPECT_NE(SayOfPoints(WithScaledK(right, 0.5), PointsOnAGrid(), false).find("K is of a smaller image"),
            std::string::npos);
  EXPECT_NE(SayOfPoints(WithScaledK(right, 2.0), PointsOnAGrid(), false).find("K is of a larger image"),
            std::string::npos);
  EXPECT_NE(SayOfPoints({319.5, 239.5, 600, 600, 0, 0}, PointsOnAGrid(), false).find("look like cx cy fx fy"),
            std::string::npos);
  EXPECT_NE(SayOfPoints({600, 319.5, 600, 239.5, 0, 0}, PointsOnAGrid(), false).find("look like fx cx fy cy"),
            std::string::npos);
  EXPECT_EQ(SayOfPoints({1, 1, 0, 0, 0, 0}, PointsOnAGrid(1.2, 1.2, -0.6), false), "");  // in units of f
  EXPECT_NE(SayOfPoints({1.5, 1.5, 319.5, 239.5, 0, 0}, PointsOnAGrid(), false).find("degrees off the axis"),
            std::string::npos);  // fx and fy in mm
  // Without distortion points lie outside, but on either side.
  EXPECT_EQ(SayOfPoints(right, PointsOnAGrid(1100, 480, -230), false), "");
  const Camera sized{600, 600, 319.5, 239.5, 640, 480};
  EXPECT_EQ(SayOfPoints(sized, PointsOnAGrid(), true), "");
  EXPECT_EQ(SayOfPoints(sized, PointsOnAGrid(300, 200), true), "");
  EXPECT_NE(SayOfPoints(sized, PointsOnAGrid(1280, 960), true).find("an image of 640 x 480 px, its size"),
            std::string::npos);
  std::vector<Correspondence> few = PointsOnAGrid(1280, 960);
  few.resize(9);
  EXPECT_EQ(SayOfPoints(sized, few, true), "");
}

// What no pinhole shows, a fisheye lens may: a corner at 74.8 deg of a pinhole is at 105 deg here.
TEST(CameraPlausibility, AFisheyeImageMayBeWide) {
  const Camera wide{300, 300, 959.5, 539.5, 1920, 1080};
  EXPECT_EQ(FindCameraDoubts(wide, "K").size(), 1U);
  EXPECT_TRUE(FindCameraDoubts(wide, "K", LensModel::kFisheye).empty());
  const Camera tiny{1, 1, 959.5, 539.5, 1920, 1080};
  EXPECT_TRUE(ThrowsInputError([&] { FindCameraDoubts(tiny, "K"); }, {"more than 89 degrees"}));
  EXPECT_NO_THROW(FindCameraDoubts(tiny, "K", LensModel::kFisheye));
  // Order and size are checked all the same.
  EXPECT_TRUE(ThrowsInputError(
      [] {
        FindCameraDoubts({300, 300, 2000, 539.5, 1920, 1080}, "K", LensModel::kFisheye);
      },
      {"is outside"}));
}

TEST(CameraPlausibility, NormalisedCoordinatesAreNamedOnce) {
  RandomStream rng({.seed = 1, .purpose = 77});
  std::vector<Correspondence> matches(60);
  for (Correspondence& match : matches) {
    for (Eigen::Vector2d* x_px : {&match.x1_px, &match.x2_px}) *x_px << rng.Normal(), 0.5 * rng.Normal();
  }
  const Camera camera1{700.0, 700.0, 319.5, 239.5, 640, 480}, camera2{710.0, 710.0, 330.5, 230.5, 640, 480};
  for (const bool is_known : {false, true}) {
    const auto doubts = FindPairDoubts(camera1, camera2, matches, {"1", "2"}, {is_known, is_known});
    ASSERT_EQ(doubts.size(), 1U);
    EXPECT_NE(doubts[0].what.find("do not look like pixels"), std::string::npos) << doubts[0].what;
  }
  matches[5].x2_px << 40.0, 30.0;
  for (const InputDoubt& doubt : FindPairDoubts(camera1, camera2, matches, {"1", "2"}))
    EXPECT_EQ(doubt.what.find("do not look like pixels"), std::string::npos) << doubt.what;
}

TEST(CameraPlausibility, ASizeThatContradictsKAndKeyPointsIsTheOneFinding) {
  const Camera camera{600, 600, 319.5, 239.5, 330, 250};
  const std::vector<InputDoubt> doubts = FindPairDoubts(camera, camera, PointsOnAGrid(), {"1", "2"});
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(doubts[0].place, "1");
  EXPECT_NE(doubts[0].what.find("outside of an image of 330 x 250 px, its size, but fit K"),
            std::string::npos)
      << doubts[0].what;
  EXPECT_NE(doubts[0].what.find("640 x 480 px; correct the size"), std::string::npos) << doubts[0].what;
}

// All the real pairs beside the project, with their sizes and as if they had none; then with half, and with
// twice, of K. A wrong warning on any of them fails, and so does a half K that is not seen.
TEST(CameraPlausibility, RealPairsPassAndHalfOfTheirKDoesNot) {
  const std::string real = SourceFolder() + "/../shared/real";
  if (!fs::exists(real)) GTEST_SKIP() << "the real pairs are not beside the project";
  int num_pairs = 0, num_large = 0, num_bare_half = 0, num_bare_double = 0;
  const std::array<std::string, 2> places = {"1", "2"};
  for (const char* folder : {"dev", "dev2/sift08", "dev2/siftmnn", "dev2/orb08"}) {
    for (const fs::path& path : MatchFilesIn(real + "/" + folder)) {
      const MatchFile file = ReadMatchFile(path.string());
      ++num_pairs;
      EXPECT_TRUE(file.doubts.empty()) << path << ": " << file.doubts[0].what;
      const auto bare = [&](double scale) {
        return FindPairDoubts(WithScaledK(file.camera1, scale), WithScaledK(file.camera2, scale),
                              file.matches, places, {false, false});
      };
      const std::vector<InputDoubt> doubts = bare(1.0);
      EXPECT_TRUE(doubts.empty()) << path << ": " << doubts[0].what;
      EXPECT_TRUE(IsNoticed(WithScaledK(file.camera1, 0.5), "an image of")) << path;
      EXPECT_TRUE(IsNoticed(WithScaledK(file.camera1, 2.0), "an image of")) << path;
      if (file.matches.size() < 50) continue;
      ++num_large;
      num_bare_half += !bare(0.5).empty();
      num_bare_double += !bare(2.0).empty();
    }
  }
  fmt::print("{} pairs, of {} with 50 matches and more without sizes half of K was seen in {}, twice in {}\n",
             num_pairs, num_large, num_bare_half, num_bare_double);
  EXPECT_GT(num_pairs, 300);
  EXPECT_GT(num_bare_half, 0.9 * num_large);
}

}  // namespace
}  // namespace rcme
