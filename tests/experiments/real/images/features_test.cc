// The front end on rendered images, whose matches are known.
#include "experiments/real/images/features.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <filesystem>
#include <set>

#include "estimator/geometry/essential_matrix.h"
#include "estimator/geometry/sampson.h"
#include "experiments/real/images/feature_cache.h"
#include "stats/median_ratio.h"
#include "stats/random.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/rendered_sequence.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {
namespace {

const RenderedCamera& TestCamera() {
  static const RenderedCamera camera;
  return camera;
}

GreyImage Rendered(double u) {
  return {TestCamera().camera.width, TestCamera().camera.height, RenderHall(TestCamera(), PoseOnWalk(u))};
}

// Of each match the distance of its second point from the true epipolar line of the first, px.
std::vector<double> DistancesFromEpipolarLines(const Features& f1, const Features& f2, double u1, double u2,
                                               const std::vector<FeatureMatch>& matches) {
  const Eigen::Matrix3d F =
      FundamentalFromEssential(EssentialFromPose(TrueMotion(PoseOnWalk(u1), PoseOnWalk(u2))),
                               TestCamera().camera, TestCamera().camera);
  std::vector<double> distances;
  for (const FeatureMatch& match : matches) {
    const KeyPoint &p1 = f1.key_points[match.at1], &p2 = f2.key_points[match.at2];
    const Eigen::Vector3d line = F * Eigen::Vector3d(p1.x_px, p1.y_px, 1.0);
    distances.push_back(line.dot(Eigen::Vector3d(p2.x_px, p2.y_px, 1.0)) / line.head<2>().norm());
  }
  return distances;
}

TEST(FrontEnd, MostMatchesOfEveryDetectorLieOnTheTrueEpipolarLines) {
  for (const auto& [name, detector] : DetectorNames()) {
    const Features f1 = DetectFeatures(Rendered(4), {detector}), f2 = DetectFeatures(Rendered(6), {detector});
    const std::vector<FeatureMatch> matches = MatchFeatures(f1, f2, {});
    ASSERT_GE(matches.size(), 150u) << name;
    const std::vector<double> distances = DistancesFromEpipolarLines(f1, f2, 4, 6, matches);
    const auto num_near = std::ranges::count_if(distances, [](double d) { return std::abs(d) < 1.5; });
    EXPECT_GE(static_cast<double>(num_near), 0.8 * static_cast<double>(matches.size())) << name;
    for (const auto at : {&FeatureMatch::at1, &FeatureMatch::at2}) {
      std::set<std::pair<float, float>> places;
      const Features& features = at == &FeatureMatch::at1 ? f1 : f2;
      for (const FeatureMatch& match : matches) {
        const KeyPoint& point = features.key_points[match.*at];
        EXPECT_TRUE(places.emplace(point.x_px, point.y_px).second) << name;
      }
    }
    const std::vector<FeatureMatch> one_way = MatchFeatures(f1, f2, {.max_ratio = 0.8, .is_mutual = false});
    EXPECT_GT(one_way.size(), matches.size()) << name;
    for (const FeatureMatch& match : matches) EXPECT_EQ(std::ranges::count(one_way, match), 1) << name;
    EXPECT_LT(MatchFeatures(f1, f2, {.max_ratio = 0.6}).size(), matches.size()) << name;
    const size_t num_strongest = DetectFeatures(Rendered(4), {detector, 100}).key_points.size();
    EXPECT_TRUE(num_strongest > 90 && num_strongest <= 100) << name << ": " << num_strongest;
  }
}

// With a ratio of 1 every match that is mutual stays, ties too; of those below 0.8 that are right a greater
// share has a low ratio: the ratio says how good a match is.
TEST(FrontEnd, WithoutTheRatioTestTheRatioIsAScore) {
  for (const auto& [name, detector] : DetectorNames()) {
    const Features f1 = DetectFeatures(Rendered(4), {detector}), f2 = DetectFeatures(Rendered(6), {detector});
    const std::vector<FeatureMatch> matches = MatchFeatures(f1, f2, {.max_ratio = 1.0});
    std::vector<FeatureMatch> below;
    for (const FeatureMatch& match : matches) {
      EXPECT_TRUE(match.ratio >= 0.0f && match.ratio <= 1.0f) << name << ": " << match.ratio;
      if (match.ratio < 0.8f) below.push_back(match);
    }
    EXPECT_GT(matches.size(), MatchFeatures(f1, f2, {.max_ratio = 0.8}).size()) << name;
    EXPECT_GT(below.size(), 100u) << name;
    const std::vector<double> distances = DistancesFromEpipolarLines(f1, f2, 4, 6, matches);
    double num_low = 0.0, num_low_near = 0.0, num_high = 0.0, num_high_near = 0.0;
    for (size_t i = 0; i < matches.size(); ++i) {
      const bool is_low = matches[i].ratio < 0.8f, is_near = std::abs(distances[i]) < 1.5;
      (is_low ? num_low : num_high) += 1.0;
      (is_low ? num_low_near : num_high_near) += is_near;
    }
    EXPECT_GT(num_low_near / num_low, num_high_near / num_high + 0.2) << name;
  }
}

// A bright disc whose centre is known to a hundredth of a pixel, at many places within a pixel.
TEST(FrontEnd, SiftPlacesADiscAtItsCentre) {
  double sum_x = 0.0, sum_y = 0.0;
  int n = 0;
  for (int k = 0; k < 25; ++k) {
    const double cx = 40.0 + 0.2 * (k % 5), cy = 30.0 + 0.2 * (k / 5);  // NOLINT(bugprone-integer-division)
    GreyImage image{81, 61, std::vector<std::uint8_t>(81 * 61)};
    for (int y = 0; y < 61; ++y) {
      for (int x = 0; x < 81; ++x) {
        const double r2 = (x - cx) * (x - cx) + (y - cy) * (y - cy);
        image.grey[static_cast<size_t>(y * 81 + x)] =
            static_cast<std::uint8_t>(std::lround(30.0 + 200.0 * std::exp(-r2 / (2.0 * 3.0 * 3.0))));
      }
    }
    for (const KeyPoint& point : DetectFeatures(image, {}).key_points) {
      if (std::hypot(point.x_px - cx, point.y_px - cy) > 1.0) continue;
      sum_x += point.x_px - cx;
      sum_y += point.y_px - cy;
      ++n;
    }
  }
  ASSERT_GE(n, 25);
  EXPECT_NEAR(sum_x / n, 0.0, 0.03);
  EXPECT_NEAR(sum_y / n, 0.0, 0.03);
}

TEST(FrontEnd, SigmaGrowsWithTheSizes) {
  const KeyPoint fine{0, 0, 2.0159f}, coarse{0, 0, 4.0f * 2.0159f};
  EXPECT_NEAR(SigmaOfMatch(Detector::kSift, fine, fine), 0.5, 1e-4);
  EXPECT_NEAR(SigmaOfMatch(Detector::kSift, coarse, coarse), 0.5 * std::pow(4.0, 0.7), 1e-3);
  EXPECT_NEAR(SigmaOfMatch(Detector::kSift, fine, coarse), 0.5 * std::pow(8.5, 0.35), 1e-3);
  const Features features = DetectFeatures(Rendered(4), {});
  for (const KeyPoint& point : features.key_points)
    EXPECT_GE(SigmaOfMatch(Detector::kSift, point, point), 0.4);
}

// The residuals at the true motion of the third of the matches with the greatest sigma over those of the
// third with the least, by their medians. By maximum likelihood they grow with the size to the power 0.8 to
// 0.9 of SIFT, 1 of ORB, 1.3 to 1.9 of AKAZE (ten pairs, two resolutions and two steps of the walk); thirds
// are coarser, above all of AKAZE, whose sizes hardly differ. Nothing is random here.
TEST(FrontEnd, ResidualsGrowAtLeastAsSigmaSays) {
  std::vector<std::pair<double, GreyImage>> images;  // at u and u + 2
  for (const double u : {4.0, 14.0, 24.0, 34.0, 44.0}) {
    images.emplace_back(u, Rendered(u));
    images.emplace_back(u + 2.0, Rendered(u + 2.0));
  }
  for (const auto& [name, detector] : DetectorNames()) {
    std::vector<std::pair<double, double>> matches;  // sigma, |residual|
    for (size_t k = 0; k < images.size(); k += 2) {
      const auto& [u1, image1] = images[k];
      const auto& [u2, image2] = images[k + 1];
      const Features f1 = DetectFeatures(image1, {detector}), f2 = DetectFeatures(image2, {detector});
      const std::vector<FeatureMatch> found = MatchFeatures(f1, f2, {});
      const std::vector<double> distances = DistancesFromEpipolarLines(f1, f2, u1, u2, found);
      for (size_t i = 0; i < found.size(); ++i) {
        const double sigma_px =
            SigmaOfMatch(detector, f1.key_points[found[i].at1], f2.key_points[found[i].at2]);
        matches.emplace_back(sigma_px, std::abs(distances[i]));
      }
    }
    std::ranges::sort(matches);
    const auto medians = [&](size_t first) {
      std::vector<double> sigmas, sizes;
      for (size_t i = first; i < first + matches.size() / 3; ++i) {
        sigmas.push_back(matches[i].first);
        sizes.push_back(matches[i].second);
      }
      return std::pair{ComputeMedian(sigmas), ComputeMedian(sizes)};
    };
    const auto [fine, fine_size] = medians(0);
    const auto [coarse, coarse_size] = medians(matches.size() - matches.size() / 3);
    const double power = 0.7 * std::log(coarse_size / fine_size) / std::log(coarse / fine);  // of the size
    EXPECT_GT(power, 0.6) << name;
    EXPECT_LT(power, detector == Detector::kAkaze ? 10.0 : 1.6) << name;
  }
}

// Dark squares of 20 px, turned and shifted at random, with a pixel's blur and noise of 3 grey values.
struct SquaresImage {
  GreyImage image{320, 240, std::vector<std::uint8_t>(320 * 240)};
  std::vector<Eigen::Vector2d> corners;
};
SquaresImage MakeSquares(std::uint32_t number) {
  constexpr double kStepPx = 40.0;
  constexpr int kRays = 6;  // of a pixel in x and in y, over 1.5 px
  SquaresImage squares;
  RandomStream rng({.seed = 1, .trial = number, .purpose = 2750});
  const Eigen::Rotation2Dd turn(1.5 * rng.Uniform());
  const Eigen::Vector2d origin(160.0 + rng.Uniform(), 120.0 + rng.Uniform());
  const auto is_dark = [&](double x, double y) {
    const Eigen::Vector2d at = turn.inverse() * (Eigen::Vector2d(x, y) - origin) / kStepPx;
    return at.x() - std::floor(at.x()) < 0.5 && at.y() - std::floor(at.y()) < 0.5;
  };
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      int num_dark = 0;
      for (int i = 0; i < kRays * kRays; ++i) {
        const int row = i / kRays, column = i % kRays;
        num_dark += is_dark(x + (column + 0.5) / 4.0 - 0.75, y + (row + 0.5) / 4.0 - 0.75);
      }
      const double grey = 200.0 - 160.0 * num_dark / (kRays * kRays) + 3.0 * rng.Normal();
      squares.image.grey[static_cast<size_t>(y * 320 + x)] =
          static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0)));
    }
  }
  for (int i = -20; i <= 20; ++i) {
    for (int j = -20; j <= 20; ++j)
      squares.corners.emplace_back(origin + turn * Eigen::Vector2d(0.5 * kStepPx * i, 0.5 * kStepPx * j));
  }
  return squares;
}

// Distance of each key point of the two finest scales from the nearest corner, px.
std::vector<double> DistancesFromCorners(const SquaresImage& squares, const Features& features) {
  std::vector<double> distances;
  for (const KeyPoint& point : features.key_points) {
    if (point.size_px > 31.0f * 1.2f + 0.1f) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& corner : squares.corners)
      least = std::min(least, (Eigen::Vector2d(point.x_px, point.y_px) - corner).norm());
    distances.push_back(least);
  }
  return distances;
}

// ORB finds these corners some 1.75 px inside of the square, the median over 2,143 key points; refined, 0.20
// px from it. Nothing is random here.
TEST(FrontEnd, RefinedKeyPointsOfOrbLieOnTheCorners) {
  std::vector<double> found, refined;
  for (std::uint32_t number = 0; number < 5; ++number) {
    const SquaresImage squares = MakeSquares(number);
    const Features plain = DetectFeatures(squares.image, {Detector::kOrb}),
                   moved = DetectFeatures(squares.image, {Detector::kOrb, 0, true});
    ASSERT_EQ(plain.key_points.size(), moved.key_points.size());
    EXPECT_EQ(plain.descriptors, moved.descriptors);
    for (size_t i = 0; i < plain.key_points.size(); ++i) {
      const KeyPoint &before = plain.key_points[i], &after = moved.key_points[i];
      const float move_px = std::hypot(after.x_px - before.x_px, after.y_px - before.y_px);
      EXPECT_LE(move_px, 2.001f);
      if (before.size_px > 31.0f * 1.2f + 0.1f) {
        EXPECT_EQ(move_px, 0.0f);
      }
    }
    for (const double d : DistancesFromCorners(squares, plain)) found.push_back(d);
    for (const double d : DistancesFromCorners(squares, moved)) refined.push_back(d);
  }
  EXPECT_GT(found.size(), 500u);
  EXPECT_GT(ComputeMedian(found), 1.2);
  EXPECT_LT(ComputeMedian(refined), 0.3);
}

TEST(FrontEnd, OnlyOrbIsRefined) {
  for (const Detector detector : {Detector::kSift, Detector::kAkaze})
    EXPECT_TRUE(ThrowsInputError(
        [&] {
          DetectFeatures(Rendered(4), {detector, 0, true});
        },
        {"--subpixel", "--detector orb"}));
}

TEST(FrontEnd, OfAnImageWithoutTextureThereIsNothing) {
  const GreyImage grey{64, 48, std::vector<std::uint8_t>(64 * 48, 100)};
  for (const auto& [name, detector] : DetectorNames()) {
    const Features none = DetectFeatures(grey, {detector});
    EXPECT_TRUE(none.key_points.empty()) << name;
    EXPECT_TRUE(MatchFeatures(none, DetectFeatures(Rendered(0), {detector}), {}).empty()) << name;
    EXPECT_TRUE(MatchFeatures(DetectFeatures(Rendered(0), {detector}), none, {}).empty()) << name;
  }
}

TEST(FeatureCache, FindsAnImageByItsContentAndMakesWhatIsDamagedAgain) {
  const TempFolder folder;
  const std::string image = folder.Path("a.png"), cached = folder.Path("cache");
  WriteImage(image, TestCamera().camera, Rendered(3).grey);
  FeatureCache cache(cached);
  const std::string first = PackFeatures(cache.Get(image, {}));
  EXPECT_EQ(cache.num_found(), 0);
  std::filesystem::copy_file(image, folder.Path("b.png"));
  EXPECT_EQ(PackFeatures(cache.Get(folder.Path("b.png"), {})), first);
  EXPECT_EQ(cache.num_found(), 1);
  cache.Get(image, {Detector::kOrb});
  cache.Get(image, {Detector::kSift, 50});
  cache.Get(image, {Detector::kOrb, 0, true});
  EXPECT_EQ(cache.num_found(), 1);
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(cached))
    files.push_back(entry.path().string());
  ASSERT_EQ(files.size(), 4u);
  for (const std::string& file : files) {
    std::string bytes = ReadBytes(file);
    EXPECT_TRUE(UnpackFeatures(bytes).has_value());
    for (const size_t size : {size_t{0}, size_t{20}, bytes.size() / 2, bytes.size() - 1})
      EXPECT_FALSE(UnpackFeatures(bytes.substr(0, size)).has_value()) << size;
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    EXPECT_FALSE(UnpackFeatures(bytes).has_value());
    std::ofstream(file, std::ios::binary) << bytes;
  }
  EXPECT_EQ(PackFeatures(cache.Get(image, {})), first);
  EXPECT_EQ(cache.num_found(), 1);
  EXPECT_EQ(PackFeatures(cache.Get(image, {})), first);
  EXPECT_EQ(cache.num_found(), 2);
  EXPECT_TRUE(ThrowsInputError([&] { cache.Get(folder.Write("c.png", "x"), {}); }, {"c.png: is not a PNG"}));
}

// A file may be whole and yet hold what no detector finds: rows of another length would end the matcher, a
// size that is no number would become a noise level.
TEST(FeatureCache, WhatTheDetectorCannotHaveFoundIsFoundAgain) {
  const ImageFeatures sound{
      100, 80, {{{10.0f, 20.0f, 4.0f}, {99.0f, 79.0f, 8.0f}}, std::vector<std::uint8_t>(64), true}};
  EXPECT_TRUE(AreFeatures(sound, Detector::kOrb));
  EXPECT_FALSE(AreFeatures(sound, Detector::kAkaze));
  EXPECT_FALSE(AreFeatures(sound, Detector::kSift));
  const auto are_after = [&](const auto& change) {
    ImageFeatures changed = sound;
    change(&changed);
    return AreFeatures(changed, Detector::kOrb);
  };
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(are_after([](ImageFeatures* image) { image->features.descriptors.push_back(0); }));
  EXPECT_FALSE(are_after([](ImageFeatures* image) { image->features.key_points.pop_back(); }));
  EXPECT_FALSE(are_after([](ImageFeatures* image) { image->features.is_binary = false; }));
  EXPECT_FALSE(are_after([](ImageFeatures* image) { image->width = 0; }));
  EXPECT_FALSE(are_after([](ImageFeatures* image) { image->height = -80; }));
  for (const float wrong : {nan, infinity, 200.0f, -2.0f}) {
    EXPECT_FALSE(are_after([&](ImageFeatures* image) { image->features.key_points[1].x_px = wrong; }))
        << wrong;
    EXPECT_FALSE(are_after([&](ImageFeatures* image) { image->features.key_points[1].y_px = wrong; }))
        << wrong;
  }
  for (const float wrong : {nan, infinity, 0.0f, -4.0f})
    EXPECT_FALSE(are_after([&](ImageFeatures* image) { image->features.key_points[1].size_px = wrong; }))
        << wrong;

  const TempFolder folder;
  const std::string path = folder.Path("a.png"), cached = folder.Path("cache");
  WriteImage(path, TestCamera().camera, Rendered(3).grey);
  FeatureCache cache(cached);
  ImageFeatures image = cache.Get(path, {Detector::kOrb});
  const std::string first = PackFeatures(image);
  const std::string kept = std::filesystem::directory_iterator(cached)->path().string();
  image.features.descriptors.pop_back();
  std::ofstream(kept, std::ios::binary) << PackFeatures(image);
  EXPECT_EQ(PackFeatures(cache.Get(path, {Detector::kOrb})), first);
  EXPECT_EQ(cache.num_found(), 0);
}

}  // namespace
}  // namespace rcme
