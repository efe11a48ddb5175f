#include "simulator/severity/homography_share.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/test_support/far_and_near_scene.h"

namespace rcme {
namespace {

// chi2_2 at 95 % of the difference of two noisy points, in units of sigma.
const double kRadiusSigma = std::sqrt(2.0) * 2.448;

double ComputeShare(const Scene& scene, std::uint32_t trial = 0) {
  RandomStream rng({1, 0, trial, 7});
  return HomographyShare(scene, scene.points_in_cam1, kRadiusSigma * 0.5, rng);
}

// The first of every ten points are moved along their rays onto the plane z = 5 + 0.2 x.
Scene WithPlane(Scene scene, size_t of_ten) {
  for (size_t i = 0; i < scene.points_in_cam1.size(); ++i) {
    Eigen::Vector3d& X = scene.points_in_cam1[i];
    if (i % 10 < of_ten) X *= 5.0 / (X.z() - 0.2 * X.x());
  }
  return scene;
}

TEST(HomographyShare, IsOneOnAPlaneAndWithoutTranslation) {
  EXPECT_EQ(ComputeShare(WithPlane(TwoCameraScene(500, 0), 10)), 1.0);
  EXPECT_EQ(ComputeShare(TwoCameraScene(500, 0, 0.0)), 1.0);
}

// 60 % on a plane are found with probability 1 - 3e-7, and are 60 +- 10 % (3 sd) of 200 points drawn; some
// others lie near the plane by chance. In a volume of depth 2 to 8 m no plane has more than a third.
TEST(HomographyShare, FindsThePlaneAmongOthers) {
  const double share = ComputeShare(WithPlane(TwoCameraScene(500, 0), 6));
  EXPECT_GT(share, 0.5);
  EXPECT_LT(share, 0.8);
  EXPECT_LT(ComputeShare(TwoCameraScene(500, 0)), 0.34);
}

// A plane explains what is within the distance: sqrt(2) 2.448 = 3.46 sigma here.
TEST(HomographyShare, ExplainsWhatIsWithinTheDistance) {
  const auto share = [](double distance_px) {
    const Scene scene = FarAndNearScene(distance_px);
    RandomStream rng({.seed = 1, .purpose = 94});
    return HomographyShare(scene, scene.points_in_cam1, kRadiusSigma, rng);
  };
  EXPECT_EQ(share(3.4), 1.0);
  EXPECT_LT(share(3.6), 1.0);
}

TEST(HomographyShare, OfNothingIsUnknownAndOfTwoPointsDefined) {
  Scene scene = TwoCameraScene(500, 0);
  scene.points_in_cam1.resize(2);
  EXPECT_GE(ComputeShare(scene), 0.0);
  scene.points_in_cam1.clear();
  EXPECT_TRUE(std::isnan(ComputeShare(scene)));
}

}  // namespace
}  // namespace rcme
