#include <gtest/gtest.h>

#include "simulator/scenes/scenes.h"
#include "tests/test_support/expect_input_error.h"
#include "tests/test_support/scene_samples.h"

namespace rcme {
namespace {

// Where a region lies, as fractions of the image.
struct RegionCase {
  const char *region, *share;
  double left, right, top, bottom;
};

class ImageRegionCase : public testing::TestWithParam<RegionCase> {};

// 5,000 points: three Kolmogorov-Smirnov tests at 1e-4 against the uniform law on exactly this rectangle and
// depth range. The same test rejects a side that is 10 %
// longer (D = 0.09, sqrt(n) D = 6.4).
TEST_P(ImageRegionCase, PointsAreUniformInTheRegionAndInDepth) {
  const RegionCase& region = GetParam();
  const auto model =
      Configured(MakeImageRegion(), {{"region", region.region}, {"region_share", region.share}});
  const std::vector<Eigen::Vector3d> points = Candidates(*DrawWorld(*model), 0, 5000);
  const std::vector<double> x = ImageX(points), y = ImageY(points);
  EXPECT_GT(UniformPValue(x, region.left, region.right), 1e-4);
  EXPECT_GT(UniformPValue(y, region.top, region.bottom), 1e-4);
  EXPECT_GT(UniformPValue(Depths(points), 2.0, 8.0), 1e-4);
  EXPECT_LT(UniformPValue(x, region.left, 1.1 * region.right), 1e-10);
}

INSTANTIATE_TEST_SUITE_P(Regions, ImageRegionCase,
                         testing::Values(RegionCase{"half", "usual", 0.0, 0.5, 0.0, 1.0},
                                         RegionCase{"half", "0.3", 0.0, 0.3, 0.0, 1.0},
                                         RegionCase{"corner", "usual", 0.0, 0.5, 0.0, 0.5},
                                         RegionCase{"corner", "0.04", 0.0, 0.2, 0.0, 0.2},
                                         RegionCase{"band", "usual", 0.0, 1.0, 0.375, 0.625},
                                         RegionCase{"band", "0.1", 0.0, 1.0, 0.45, 0.55},
                                         RegionCase{"full", "usual", 0.0, 1.0, 0.0, 1.0},
                                         RegionCase{"full", "1", 0.0, 1.0, 0.0, 1.0}),
                         [](const auto& region) {
                           return region.param.region + std::to_string(region.index);
                         });

TEST(ImageRegion, TheWholeImageIsTheUniformVolume) {
  SceneGenerator full("image_region"), volume("uniform_volume");
  Set(full, {{"region", "full"}});
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    EXPECT_EQ(Generate(full, trial).points_in_cam1, Generate(volume, trial).points_in_cam1);
  }
}

TEST(ImageRegion, ContradictionsAndImpossibleRequestsNameTheirKeys) {
  const auto refuses = [](const Settings& settings, const std::vector<std::string>& fragments) {
    SceneGenerator generator("image_region");
    Set(generator, settings);
    return ThrowsInputError([&] { Generate(generator, 0); }, fragments);
  };
  EXPECT_TRUE(refuses({{"min_depth_m", "9"}}, {"min_depth_m: 9 is not allowed", "max_depth_m = 8"}));
  EXPECT_TRUE(refuses({{"region", "full"}, {"region_share", "0.5"}},
                      {"region_share: 0.5", "region = full", "usual"}));
  EXPECT_TRUE(refuses({{"focal_px", "1000000"}}, {"region", "baseline_m"}));
}

}  // namespace
}  // namespace rcme
