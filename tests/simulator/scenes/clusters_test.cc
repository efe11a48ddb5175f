#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "simulator/scenes/scenes.h"
#include "stats/distributions.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

// How many points have how many points within 0.1 mm, themselves included.
std::map<int, int> CountBySizeOfCluster(const std::vector<Eigen::Vector3d>& points) {
  std::map<int, int> num_points_of_size;
  for (const Eigen::Vector3d& a : points) {
    int size = 0;
    for (const Eigen::Vector3d& b : points) size += (a - b).norm() < 1e-4;
    ++num_points_of_size[size];
  }
  return num_points_of_size;
}

// Clusters of a micrometre tell themselves apart. (Two of at most 250 background points within 0.1 mm in some
// 100 m^3: probability 1e-9.)
TEST(Clusters, TheSharesOfBackgroundAndClustersAreExact) {
  using Sizes = std::map<int, int>;
  SceneGenerator generator("clusters");
  Set(generator, {{"cluster_spread_m", "1e-6"}});
  EXPECT_EQ(CountBySizeOfCluster(Generate(generator, 0).points_in_cam1), (Sizes{{1, 100}, {80, 400}}));
  Set(generator, {{"clustered_share", "0.5"}, {"largest_share", "0.6"}});
  EXPECT_EQ(CountBySizeOfCluster(Generate(generator, 1).points_in_cam1),
            (Sizes{{1, 250}, {25, 100}, {150, 150}}));
  Set(generator, {{"clustered_share", "1"}, {"num_clusters", "1"}, {"largest_share", "equal"}});
  EXPECT_EQ(CountBySizeOfCluster(Generate(generator, 2).points_in_cam1), (Sizes{{500, 500}}));
}

// Differences of two points of a cluster are normal with twice the variance: 3 x 5,000 of them,
// Kolmogorov-Smirnov at 1e-4. A spread 15 % off (D = 0.034, sqrt(n) D = 4.2) would give p < 1e-14.
TEST(Clusters, PointsAreGaussianAroundTheCentre) {
  const auto model = Configured(MakeClusters(), {{"cluster_spread_m", "0.01"}, {"min_depth_m", "5"}});
  const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*model), 3, 10'000);
  std::vector<double> differences;
  for (size_t i = 0; i + 1 < points.size(); i += 2) {
    for (int k = 0; k < 3; ++k) {
      differences.push_back((points[i](k) - points[i + 1](k)) / (0.01 * std::numbers::sqrt2));
    }
  }
  EXPECT_GT(TestKolmogorovSmirnov(differences, NormalCdf).p_value, 1e-4);
  for (double& difference : differences) difference *= 1.15;
  EXPECT_LT(TestKolmogorovSmirnov(differences, NormalCdf).p_value, 1e-6);
}

// The centres of 3,000 worlds; three Kolmogorov-Smirnov tests at 1e-4. The same test sees centres that are
// uniform in the square of the depth.
TEST(Clusters, CentresAreUniformInTheVolume) {
  const auto model = Configured(MakeClusters(), {{"cluster_spread_m", "1e-9"}, {"num_clusters", "3"}});
  std::vector<Eigen::Vector3d> centres;
  for (std::uint32_t trial = 0; trial < 1000; ++trial) {
    const auto world = DrawWorld(*model, trial);
    for (const size_t part : {1, 2, 3}) centres.push_back(Candidates(*world, part, 1)[0]);
  }
  EXPECT_GT(UniformPValue(ImageX(centres)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(centres)), 1e-4);
  std::vector<double> depths_m = Depths(centres);
  EXPECT_GT(UniformPValue(depths_m, 2.0, 8.0), 1e-4);
  for (double& depth_m : depths_m) depth_m = depth_m * depth_m;
  EXPECT_LT(UniformPValue(depths_m, 4.0, 64.0), 1e-10);
}

TEST(Clusters, BothImagesShowEveryCentre) {
  const auto model = Configured(MakeClusters(), {{"cluster_spread_m", "1e-9"}});
  ViewPair view = StillView();
  view.cam2_from_cam1_true.R = RotationFromVector({0.2, 0.3, 0.1});
  view.baseline_m = 0.5;
  for (std::uint32_t trial = 0; trial < 200; ++trial) {
    RandomStream rng({1, 0, trial, 1});
    const auto world = model->DrawWorld(view, rng);
    for (size_t part = 1; part <= 5; ++part) EXPECT_TRUE(view.Sees(Candidates(*world, part, 1)[0]));
  }
}

TEST(Clusters, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("clusters");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"min_depth_m", "9"}}, {"min_depth_m: 9 is not allowed", "max_depth_m = 8"}));
  EXPECT_TRUE(
      refuses({{"largest_share", "0.1"}}, {"largest_share: 0.1", "num_clusters = 5", "at least 0.2"}));
  EXPECT_TRUE(refuses({{"largest_share", "0.5"}, {"num_clusters", "1"}},
                      {"largest_share: 0.5", "num_clusters = 1", "equal or 1"}));
  EXPECT_TRUE(refuses({{"focal_px", "1000000"}}, {"num_clusters", "min_depth_m", "max_depth_m"}));
}

}  // namespace
}  // namespace rcme
