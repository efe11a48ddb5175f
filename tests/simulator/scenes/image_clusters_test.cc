#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "stats/distributions.h"
#include "stats/moments.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

std::vector<Eigen::Vector2d> Pixels(const std::vector<Eigen::Vector3d>& points_in_cam1) {
  const Camera camera = StillView().camera1;
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& point : points_in_cam1) pixels.push_back(camera.Project(point));
  return pixels;
}

TEST(ImageClusters, WithoutClusteredPointsItIsTheUniformVolumeToTheBit) {
  SceneGenerator clusters("image_clusters"), volume("uniform_volume");
  Set(clusters, {{"clustered_share", "0"}});
  for (std::uint32_t trial = 0; trial < 50; ++trial) {
    EXPECT_EQ(Generate(clusters, trial).points_in_cam1, Generate(volume, trial).points_in_cam1);
  }
}

// Differences of two offspring of one parent: 2 x 5,000 of them, Kolmogorov-Smirnov at 1e-4. A spread 15 %
// off (D = 0.034, sqrt(n) D = 3.4) would give p < 1e-9.
TEST(ImageClusters, GaussianOffspringHasTheSpreadAsItsStandardDeviation) {
  const auto model = Configured(MakeImageClusters(), {{"num_clusters", "1"}, {"cluster_spread_px", "5"}});
  const std::vector<Eigen::Vector2d> pixels = Pixels(Candidates(*DrawWorld(*model), 1, 10'000));
  std::vector<double> differences;
  for (size_t i = 0; i + 1 < pixels.size(); i += 2) {
    for (int k = 0; k < 2; ++k) {
      differences.push_back((pixels[i](k) - pixels[i + 1](k)) / (5.0 * std::numbers::sqrt2));
    }
  }
  EXPECT_GT(TestKolmogorovSmirnov(differences, NormalCdf).p_value, 1e-4);
  for (double& difference : differences) difference *= 1.15;
  EXPECT_LT(TestKolmogorovSmirnov(differences, NormalCdf).p_value, 1e-6);
}

// Uniform in a disc: the square of the distance from the middle is uniform, and so is the angle. 5,000
// offspring, Kolmogorov-Smirnov at 1e-4. The middle is known to 0.7 % of the radius, which moves the law by D
// below 0.005 against the test's 0.031. The same test sees a disc whose radius is uniform.
TEST(ImageClusters, DiscOffspringIsUniformInTheDisc) {
  const auto model = Configured(
      MakeImageClusters(), {{"num_clusters", "1"}, {"cluster_spread_px", "5"}, {"cluster_shape", "disc"}});
  const std::vector<Eigen::Vector2d> pixels = Pixels(Candidates(*DrawWorld(*model), 1, 5000));
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& pixel : pixels) middle += pixel / 5000.0;
  std::vector<double> areas, radii, angles;
  for (const Eigen::Vector2d& pixel : pixels) {
    const Eigen::Vector2d offset = pixel - middle;
    radii.push_back(offset.norm() / 5.0);
    areas.push_back(std::min(radii.back() * radii.back(), 1.0));
    angles.push_back(std::atan2(offset.y(), offset.x()));
  }
  EXPECT_GT(UniformPValue(areas), 1e-4);
  EXPECT_GT(UniformPValue(angles, -std::numbers::pi, std::numbers::pi), 1e-4);
  EXPECT_LT(UniformPValue(radii), 1e-10);
  EXPECT_LT(*std::ranges::max_element(radii), 1.03);
}

// 3,000 parents, recovered from offspring that stays with them; Kolmogorov-Smirnov at 1e-4. The same test
// rejects parents that are a tenth of the width to the right (sqrt(n) D = 5.5).
TEST(ImageClusters, ParentsAreUniformOverImage1) {
  const auto model = Configured(MakeImageClusters(), {{"num_clusters", "1"}, {"cluster_spread_px", "1e-6"}});
  std::vector<Eigen::Vector3d> parents;
  for (std::uint32_t trial = 0; trial < 3000; ++trial) {
    parents.push_back(Candidates(*DrawWorld(*model, trial), 1, 1)[0]);
  }
  std::vector<double> x = ImageX(parents);
  EXPECT_GT(UniformPValue(x), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(parents)), 1e-4);
  for (double& value : x) value += 0.1;
  EXPECT_LT(UniformPValue(x), 1e-10);
}

TEST(ImageClusters, BothImagesShowEveryParentAtTheMiddleDepth) {
  const auto model = Configured(MakeImageClusters(), {{"cluster_spread_px", "1e-6"}});
  ViewPair view = StillView();
  view.cam2_from_cam1_true.R = RotationFromVector({0.2, 0.3, 0.1});
  view.baseline_m = 0.5;
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    RandomStream rng({1, 0, trial, 1});
    for (const Eigen::Vector3d& point : Candidates(*model->DrawWorld(view, rng), 1, 50)) {
      EXPECT_TRUE(view.Sees(5.0 / point.z() * point));
    }
  }
}

// Pearson's chi-square of 10,000 offspring of 10 parents at 1e-4; one parent with a quarter more than its due
// gives 62 more on average, p < 1e-6.
TEST(ImageClusters, EveryParentIsEquallyLikely) {
  const auto model = Configured(MakeImageClusters(), {{"cluster_spread_px", "1e-6"}});
  std::map<std::pair<int, int>, double> num_offspring;
  for (const Eigen::Vector2d& pixel : Pixels(Candidates(*DrawWorld(*model), 1, 10'000))) {
    ++num_offspring[{static_cast<int>(std::lround(1000.0 * pixel.x())),
                     static_cast<int>(std::lround(1000.0 * pixel.y()))}];
  }
  ASSERT_EQ(num_offspring.size(), 10u);
  const auto p_value = [&] {
    double statistic = 0.0;
    for (const auto& [parent, count] : num_offspring)
      statistic += (count - 1000.0) * (count - 1000.0) / 1000.0;
    return 1.0 - ChiSquareCdf(9, statistic);
  };
  EXPECT_GT(p_value(), 1e-4);
  num_offspring.begin()->second += 250.0;
  EXPECT_LT(p_value(), 1e-6);
}

// Clusters of a micropixel: a clustered point has another one beside it. (A parent with one point of 150, or
// two background points as near: probability below 1e-5.)
TEST(ImageClusters, TheClusteredShareIsExact) {
  SceneGenerator generator("image_clusters");
  Set(generator, {{"clustered_share", "0.3"}, {"cluster_spread_px", "1e-6"}});
  for (std::uint32_t trial = 0; trial < 10; ++trial) {
    const std::vector<Eigen::Vector2d> pixels = Pixels(Generate(generator, trial).points_in_cam1);
    int num_clustered = 0;
    for (const Eigen::Vector2d& a : pixels) {
      num_clustered +=
          std::ranges::count_if(pixels, [&](const auto& b) { return (a - b).norm() < 1e-3; }) > 1;
    }
    EXPECT_EQ(num_clustered, 150);
  }
}

// Depths of one cluster: uniform (Kolmogorov-Smirnov at 1e-4, n = 10,000), and of neighbours in the list
// uncorrelated: 4.5 / sqrt(n), false alarms 7e-6. One depth per cluster would fail both.
TEST(ImageClusters, EachOffspringHasADepthOfItsOwn) {
  const auto model = Configured(MakeImageClusters(), {{"num_clusters", "1"}});
  const std::vector<double> depths_m = Depths(Candidates(*DrawWorld(*model), 1, 10'000));
  EXPECT_GT(UniformPValue(depths_m, 2.0, 8.0), 1e-4);
  double correlation = 0.0;
  for (size_t i = 0; i + 1 < depths_m.size(); ++i) {
    correlation += (depths_m[i] - 5.0) * (depths_m[i + 1] - 5.0) / 3.0 / 10'000.0;  // variance 6^2 / 12
  }
  EXPECT_LT(std::abs(correlation), 4.5 / std::sqrt(10'000.0));
}

// The knob: variance over mean of the number of matches in squares of 80 px, over all squares of 30 scenes.
// It is 1 for even matches (and a little more, as image 2 does not show all of image 1), and grows by a
// quarter a step and more (here by 1.6 at the least): clusters of 20 matches in about four squares.
TEST(ImageClusters, MatchesCrowdMoreAsTheClusteredShareGrows) {
  SceneGenerator generator("image_clusters");
  double last = 0.0;
  for (const char* share : {"0", "0.25", "0.5", "0.75", "1"}) {
    Set(generator, {{"clustered_share", share}, {"num_matches", "200"}});
    Moments counts;
    for (std::uint32_t trial = 0; trial < 30; ++trial) {
      std::array<int, 48> count{};
      for (const Eigen::Vector2d& pixel : Pixels(Generate(generator, trial).points_in_cam1)) {
        const int column = std::clamp(static_cast<int>((pixel.x() + 0.5) / 80.0), 0, 7);
        const int row = std::clamp(static_cast<int>((pixel.y() + 0.5) / 80.0), 0, 5);
        ++count[static_cast<size_t>(8 * row + column)];
      }
      for (const int n : count) counts.Add(n);
    }
    const double dispersion = counts.variance() / counts.mean();
    EXPECT_GT(dispersion, 1.25 * last) << share;
    last = dispersion;
  }
}

TEST(ImageClusters, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("image_clusters");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"min_depth_m", "9"}}, {"min_depth_m: 9 is not allowed", "max_depth_m = 8"}));
  EXPECT_TRUE(refuses({{"focal_px", "1000000"}}, {"num_clusters", "min_depth_m", "max_depth_m"}));
  EXPECT_TRUE(refuses({{"cluster_spread_px", "100000"}}, {"cluster_spread_px", "clustered_share"}));
}

}  // namespace
}  // namespace rcme
