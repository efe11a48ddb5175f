#include <gtest/gtest.h>

#include <cmath>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

// 5,000 points a part, Kolmogorov-Smirnov at 1e-4; a far depth that is uniform in its logarithm is rejected.
TEST(FarPoints, NearAndFarPointsAreUniformVolumes) {
  const auto world = DrawWorld(*Configured(MakeFarPoints(), {{"far_depth_m", "500"}}));
  const std::vector<Eigen::Vector3d> near = Candidates(*world, 0, 5000), far = Candidates(*world, 1, 5000);
  EXPECT_GT(UniformPValue(Depths(near), 2.0, 8.0), 1e-4);
  EXPECT_GT(UniformPValue(Depths(far), 500.0, 5000.0), 1e-4);
  EXPECT_GT(UniformPValue(ImageX(far)), 1e-4);
  EXPECT_GT(UniformPValue(ImageY(far)), 1e-4);
  std::vector<double> exponentials;
  for (const double depth_m : Depths(far)) exponentials.push_back(50.0 * std::pow(10.0, depth_m / 2500.0));
  EXPECT_LT(UniformPValue(exponentials, 50.0, 5000.0), 1e-10);
}

TEST(FarPoints, TheirShareIsExactAndTheyHaveNoParallax) {
  SceneGenerator generator("far_points");
  for (const auto& [share, num_far] : {std::pair{"0", 0}, {"0.3", 150}, {"1", 500}}) {
    Set(generator, {{"far_share", share}});
    const Scene scene = Generate(generator, 0);
    int num_far_drawn = 0;
    for (const Eigen::Vector3d& point : scene.points_in_cam1) {
      if (point.z() < 1e4) continue;
      ++num_far_drawn;
      const Eigen::Vector3d ray_in_cam2 = scene.cam2_from_cam1_true.R * point;
      EXPECT_LT(AngleBetween(ray_in_cam2, scene.InCamera2(point)), 0.5 / 1e4);  // 0.035 px
    }
    EXPECT_EQ(num_far_drawn, num_far);
  }
}

TEST(FarPoints, ContradictionsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("far_points");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"min_depth_m", "9"}}, {"min_depth_m: 9 is not allowed", "max_depth_m = 8"}));
  EXPECT_TRUE(refuses({{"far_depth_m", "7"}}, {"far_depth_m: 7 is not allowed", "max_depth_m = 8"}));
  EXPECT_TRUE(refuses({{"focal_px", "1000000"}}, {"far_share", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
