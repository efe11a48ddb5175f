// Images of more bits, and of more pixels, than key points are looked for in.
#include "experiments/real/images/grey_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/geometry/essential_matrix.h"
#include "experiments/real/images/feature_cache.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

// A PGM; numbers beyond 255 take two bytes.
std::string MakePgm(int width, int height, int greatest, const std::vector<int>& values) {
  std::string text =
      "P5\n" + std::to_string(width) + " " + std::to_string(height) + "\n" + std::to_string(greatest) + "\n";
  for (const int value : values) {
    if (greatest > 255) text += static_cast<char>(value >> 8);
    text += static_cast<char>(value & 255);
  }
  return text;
}

std::vector<std::uint8_t> UnpackScaled(int factor, int greatest, const std::vector<int>& values) {
  std::vector<int> scaled;
  for (const int value : values) scaled.push_back(factor * value);
  return UnpackImage(MakePgm(16, 16, greatest, scaled), "a.pgm").grey;
}

// The same picture as sensors of 8 to 16 bits write it. Catches `>> 8` of 12 bits, by which it is black.
TEST(GreyImage, APictureIsAsBrightInAnyNumberOfBits) {
  std::vector<int> values;
  std::vector<std::uint8_t> grey;
  for (int i = 0; i < 256; ++i) {
    values.push_back(i);
    grey.push_back(static_cast<std::uint8_t>(i));
  }
  EXPECT_EQ(UnpackScaled(1, 255, values), grey);
  EXPECT_EQ(UnpackScaled(1, 65535, values), grey) << "8 bits in 16";
  EXPECT_EQ(UnpackScaled(4, 65535, values), grey) << "10 bits in 16";
  EXPECT_EQ(UnpackScaled(16, 65535, values), grey) << "12 bits in 16";
  EXPECT_EQ(UnpackScaled(64, 65535, values), grey) << "14 bits in 16";
  EXPECT_EQ(UnpackScaled(256, 65535, values), grey) << "12 bits in the upper ones of 16";
  EXPECT_EQ(UnpackScaled(257, 65535, values), grey) << "16 bits";
}

// 17.2 megapixels: halved, each pixel the mean of four; the odd column and row are cut off.
TEST(GreyImage, OneOfTooManyPixelsIsScaledDownByMeans) {
  constexpr int kWidth = 4201, kHeight = 4101;
  std::string pgm = "P5 4201 4101 255\n";
  pgm.resize(pgm.size() + static_cast<size_t>(kWidth) * kHeight);
  const auto at = [&](int x, int y) -> char& {
    return pgm[pgm.size() - static_cast<size_t>(kWidth) * kHeight + static_cast<size_t>(y) * kWidth +
               static_cast<size_t>(x)];
  };
  at(100, 60) = at(101, 60) = at(100, 61) = 80;
  at(4200, 0) = at(0, 4100) = static_cast<char>(255);
  const GreyImage image = UnpackImage(pgm, "a.pgm");
  EXPECT_EQ(image.scale, 2);
  EXPECT_EQ(image.width, 2100);
  EXPECT_EQ(image.height, 2050);
  EXPECT_EQ(image.full_width, kWidth);
  EXPECT_EQ(image.full_height, kHeight);
  for (size_t i = 0; i < image.grey.size(); ++i) {
    const size_t expected = i == 30u * 2100u + 50u ? 60 : 0;
    ASSERT_EQ(image.grey[i], expected) << i;
  }
  EXPECT_EQ(UnpackImage(MakePgm(4, 2, 255, {1, 2, 3, 4, 5, 6, 7, 8}), "a.pgm").scale, 1);
}

GreyImage ScaleByTwo(const GreyImage& full) {
  GreyImage half{full.width / 2, full.height / 2, {}, 2, full.width, full.height};
  for (int y = 0; y < half.height; ++y) {
    for (int x = 0; x < half.width; ++x) {
      int sum = 2;
      for (int k = 0; k < 4; ++k)
        sum += full.grey[static_cast<size_t>((2 * y + k / 2) * full.width + 2 * x + k % 2)];
      half.grey.push_back(static_cast<std::uint8_t>(sum / 4));
    }
  }
  return half;
}

// A bright disc whose centre is known, at many places within the pixel of the scaled image. Catches a centre
// that is half a pixel off: K would have to be off by as much.
TEST(GreyImage, KeyPointsOfAScaledImageAreInTheFilesPixels) {
  double sum_x = 0.0, sum_y = 0.0, size = 0.0;
  int n = 0;
  for (int k = 0; k < 25; ++k) {
    const double cx = 80.0 + 0.4 * (k % 5), cy = 60.0 + 0.4 * (k / 5);  // NOLINT(bugprone-integer-division)
    GreyImage image{162, 122, std::vector<std::uint8_t>(162 * 122)};
    for (int y = 0; y < image.height; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const double r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
        image.grey[static_cast<size_t>(y * image.width + x)] =
            static_cast<std::uint8_t>(std::lround(30.0 + 200.0 * std::exp(-r2 / (2.0 * 6.0 * 6.0))));
      }
    }
    const Features features = DetectFeatures(ScaleByTwo(image), {});
    EXPECT_EQ(features.scale, 2);
    for (const KeyPoint& point : features.key_points) {
      if (std::hypot(point.x_px - cx, point.y_px - cy) > 2.0) continue;
      sum_x += point.x_px - cx;
      sum_y += point.y_px - cy;
      size += point.size_px;
      ++n;
    }
  }
  ASSERT_GE(n, 25);
  EXPECT_NEAR(sum_x / n, 0.0, 0.06);
  EXPECT_NEAR(sum_y / n, 0.0, 0.06);
  EXPECT_NEAR(size / n, 2.0 * 6.0, 3.0);  // the diameter of what was found, here of the scale of the disc
}

// Matches of two scaled views lie on the epipolar lines of the cameras as they are, and their sigma is twice
// as large as that of the same key points in an image of that size.
TEST(GreyImage, MatchesOfScaledImagesFitTheCameraAsItIs) {
  RenderedCamera camera;
  camera.camera = {520.0, 524.0, 317.1, 243.7, 640, 480};
  const auto render = [&](double u) {
    return DetectFeatures(ScaleByTwo({640, 480, RenderHall(camera, PoseOnWalk(u))}), {});
  };
  const Features f1 = render(4), f2 = render(6);
  const Eigen::Matrix3d F = FundamentalFromEssential(
      EssentialFromPose(TrueMotion(PoseOnWalk(4), PoseOnWalk(6))), camera.camera, camera.camera);
  const std::vector<FeatureMatch> matches = MatchFeatures(f1, f2, {});
  ASSERT_GE(matches.size(), 150u);
  int num_near = 0;
  for (const FeatureMatch& match : matches) {
    const KeyPoint &p1 = f1.key_points[match.at1], &p2 = f2.key_points[match.at2];
    const Eigen::Vector3d line = F * Eigen::Vector3d(p1.x_px, p1.y_px, 1.0);
    num_near += std::abs(line.dot(Eigen::Vector3d(p2.x_px, p2.y_px, 1.0))) < 3.0 * line.head<2>().norm();
  }
  EXPECT_GE(num_near, 0.8 * static_cast<double>(matches.size()));
  const KeyPoint fine{0, 0, 2.0159f}, twice{0, 0, 2.0f * 2.0159f};
  EXPECT_NEAR(SigmaOfMatch(Detector::kSift, twice, twice, 2, 2), 1.0, 1e-4);
  EXPECT_NEAR(SigmaOfMatch(Detector::kSift, fine, twice, 1, 2), 0.5 * std::sqrt(2.5), 1e-4);
  const ImageFeatures packed{640, 480, f1};
  EXPECT_EQ(UnpackFeatures(PackFeatures(packed))->features.scale, 2);
}

TEST(GreyImage, NumbersThatAreNotWholeAreRefused) {
  // A TIFF of one pixel of 32 bits, floating point: 10 entries, the pixel behind them.
  std::string tiff("II*\0\x08\0\0\0\x0A\0", 10);
  const auto entry = [&](int tag, int type, int value) {
    for (const int x : {tag, type}) tiff += {static_cast<char>(x & 255), static_cast<char>(x >> 8)};
    tiff += std::string("\1\0\0\0", 4);
    for (int k = 0; k < 4; ++k) tiff += static_cast<char>(value >> (8 * k));
  };
  for (const auto& [tag, value] : std::initializer_list<std::pair<int, int>>{{256, 1},
                                                                             {257, 1},
                                                                             {258, 32},
                                                                             {259, 1},
                                                                             {262, 1},
                                                                             {273, 134},
                                                                             {277, 1},
                                                                             {278, 1},
                                                                             {279, 4},
                                                                             {339, 3}})
    entry(tag, tag == 273 || tag == 279 ? 4 : 3, value);
  tiff += std::string(4, '\0') + std::string("\0\0\x80\x3F", 4);
  EXPECT_TRUE(ThrowsInputError([&] { UnpackImage(tiff, "a.tif"); }, {"a.tif: "}));
}

}  // namespace
}  // namespace rcme
