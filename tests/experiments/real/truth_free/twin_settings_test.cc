#include "experiments/real/truth_free/twin_settings.h"

#include <gtest/gtest.h>

#include "experiments/data/make_data.h"
#include "parameters/settings.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TwinFit SomeFit() {
  TwinFit fit;
  fit.camera1 = TestCamera1();
  fit.camera2 = TestCamera2();
  fit.num_matches = 200;
  fit.wrong_share = 0.25;
  fit.rotation_deg = 1.5;
  fit.parallax_deg = 4.0;
  fit.forwardness = 0.1;
  fit.nearest = 5.0;
  fit.farthest = 15.0;
  fit.homography_share = 0.4;
  fit.clark_evans = 1.0;
  fit.simulated_noise.noise_px = 0.3;
  return fit;
}

std::string ReadValue(const TwinFit& fit, const std::string& key) {
  const Settings settings = SimulatedTwinData(fit, 0.3, 0.5);
  return FindSetting(settings, key).value_or("");
}

// A camera that turns less than half of what it sees of parallax goes sideways, with rotations uniform up to
// twice the median; one that turns more goes about the scene.
TEST(SimulatedTwinData, MovesAsTheFit) {
  TwinFit fit = SomeFit();
  EXPECT_EQ(ReadValue(fit, "motion"), "sideways");
  EXPECT_EQ(ReadValue(fit, "max_rotation_deg"), "3");
  EXPECT_EQ(ReadValue(fit, "parallax_deg"), "4");
  fit.rotation_deg = 2.1;
  EXPECT_EQ(ReadValue(fit, "motion"), "orbit");
  EXPECT_EQ(ReadValue(fit, "orbit_deg"), "2.1");
  fit.forwardness = 0.6;
  EXPECT_EQ(ReadValue(fit, "motion"), "general");
  fit.forwardness = 0.95;
  EXPECT_EQ(ReadValue(fit, "motion"), "forward");
}

TEST(SimulatedTwinData, HasTheCamerasOfTheFit) {
  const TwinFit fit = SomeFit();
  EXPECT_EQ(ReadValue(fit, "fx1_px"), "700");
  EXPECT_EQ(ReadValue(fit, "fy1_px"), "650");
  EXPECT_EQ(ReadValue(fit, "image1_width"), "640");
  EXPECT_EQ(ReadValue(fit, "fx2_px"), "820");
  EXPECT_EQ(ReadValue(fit, "cy2_px"), "310");
  EXPECT_EQ(ReadValue(fit, "image2_height"), "600");
}

// Where a homography explains nearly all: a plane in the middle of the depths, the rest within them.
TEST(SimulatedTwinData, HasThePointsOfTheFit) {
  TwinFit fit = SomeFit();
  EXPECT_EQ(ReadValue(fit, "scene"), "image_clusters");
  EXPECT_EQ(ReadValue(fit, "min_depth_m"), "5");
  EXPECT_EQ(ReadValue(fit, "max_depth_m"), "15");
  EXPECT_EQ(ReadValue(fit, "clustered_share"), "0.3");
  EXPECT_EQ(ReadValue(fit, "num_matches"), "200");
  EXPECT_EQ(ReadValue(fit, "outlier_ratio"), "0.25");
  EXPECT_EQ(ReadValue(fit, "outliers"), "uniform");
  fit.wrong_agreeing_share = 0.4;
  EXPECT_EQ(ReadValue(fit, "outliers"), "clustered_both");
  fit.homography_share = 0.9;
  EXPECT_EQ(ReadValue(fit, "scene"), "plane_and_parallax");
  EXPECT_EQ(ReadValue(fit, "plane_depth_m"), "10");
  EXPECT_EQ(ReadValue(fit, "off_plane_m"), "5");
  EXPECT_EQ(ReadValue(fit, "off_plane_share"), "0.1");
  EXPECT_NO_THROW(MakeSimulatedData(SimulatedTwinData(SomeFit(), 0.3, 0.5)));
}

// Points at random need no clusters, points far nearer to each other than that need most of all.
TEST(FitClusteredShare, FollowsHowNearPointsAre) {
  TwinFit fit = SomeFit();
  EXPECT_EQ(FitClusteredShare(fit), 0.0);
  fit.clark_evans = 0.4;
  EXPECT_GE(FitClusteredShare(fit), 0.6);
  fit.homography_share = 0.9;
  EXPECT_EQ(FitClusteredShare(fit), 0.0);
}

TEST(SemiRealData, IsOfTheTemplatesWithTheNoiseOfTheFit) {
  TwinFit fit = SomeFit();
  fit.noise.noise_px = 0.25;
  const Settings data = SemiRealData(fit, "templates", 0.5);
  EXPECT_EQ(FindSetting(data, "folder"), "templates");
  EXPECT_EQ(FindSetting(data, "sigma_px"), "0.5");
  EXPECT_EQ(FindSetting(data, "redraw_noise_px"), "0.25");
}

}  // namespace
}  // namespace rcme
