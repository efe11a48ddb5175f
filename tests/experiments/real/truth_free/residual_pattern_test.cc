// Sizes, tails and products of residuals, of matches that are put at known distances from a motion.
#include "experiments/real/truth_free/residual_pattern.h"

#include <gtest/gtest.h>

#include <cmath>

#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/twin.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Right matches of a scene, each moved off its epipolar lines, along the gradient, by `off_px` of its number.
struct Placed {
  MotionProblem problem;
  MotionEstimate estimate;
};
Placed PlaceAt(const std::vector<double>& off_px, double sigma_px) {
  RelativePose pose;
  Placed placed;
  placed.problem = TwoCameraProblem(static_cast<int>(off_px.size()), 1e-9, 0.0, 1, &pose);
  const Eigen::Matrix3d F = ComputeFundamental(placed.problem, pose);
  for (size_t i = 0; i < off_px.size(); ++i) {
    Correspondence& match = placed.problem.matches[i];
    const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
    match.x1_px += off_px[i] * u.head<2>();
    match.x2_px += off_px[i] * u.tail<2>();
    placed.estimate.inliers.push_back(static_cast<int>(i));
  }
  placed.estimate.status = MotionStatus::kOk;
  placed.estimate.cam2_from_cam1 = pose;
  placed.estimate.sigma_estimated_px = sigma_px;
  return placed;
}

TEST(ResidualSizes, AreDistancesOverTheNoise) {
  Placed placed = PlaceAt({0.5, -1.0, 2.0}, 0.25);
  placed.problem.noise_scale = {1.0, 2.0, 0.5};
  const std::vector<double> sizes = ResidualSizes(placed.problem, placed.estimate);
  ASSERT_EQ(sizes.size(), 3u);
  EXPECT_NEAR(sizes[0], 2.0, 0.02);
  EXPECT_NEAR(sizes[1], 2.0, 0.02);
  EXPECT_NEAR(sizes[2], 16.0, 0.16);
}

// Of 1 to 100 sigma the 95 % point is 95 and the median 50 (ranks 94 and 49 of 0 to 99); of two pairs the
// noise is the root of the product.
TEST(PatternSum, TakesTailsAndTheGeometricMean) {
  std::vector<double> off_px;
  for (int i = 1; i <= 100; ++i) off_px.push_back(0.01 * i);
  const Placed first = PlaceAt(off_px, 0.01), second = PlaceAt(off_px, 0.04);
  PatternSum one;
  one.Add(first.problem, first.estimate);
  EXPECT_NEAR(one.Take().sigma_px, 0.01, 1e-12);
  EXPECT_NEAR(one.Take().tail_ratio, 95.0 / 50.0, 0.01);
  PatternSum both = one;
  both.Add(second.problem, second.estimate);
  EXPECT_NEAR(both.Take().sigma_px, 0.02, 1e-12);
  MotionEstimate refusal;
  refusal.status = MotionStatus::kNoCandidate;
  both.Add(first.problem, refusal);
  EXPECT_NEAR(both.Take().sigma_px, 0.02, 1e-12);
}

}  // namespace
}  // namespace rcme
