#include <gtest/gtest.h>

#include <array>

#include "estimator/geometry/sampson.h"
#include "experiments/real/truth_free/residual_pattern.h"
#include "experiments/real/truth_free/twin.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

// Three matches at one place, 0.2, 0.6 and -0.1 px off their epipolar lines and said to be 1, 3 and 1/2 times
// as noisy as usual: residuals of 0.2, 0.2 and -0.2 px, whose products over their mean square are 1, -1 and
// -1.
TEST(SumProducts, AreOfResidualsOverTheirNoise) {
  RelativePose pose;
  MotionProblem problem = TwoCameraProblem(1, 1e-9, 0.0, 1, &pose);
  problem.matches.resize(3, problem.matches[0]);
  problem.noise_scale = {1.0, 3.0, 0.5};
  const double off_px[] = {0.2, 0.6, -0.1};
  const Eigen::Matrix3d F = ComputeFundamental(problem, pose);
  MotionEstimate estimate;
  estimate.cam2_from_cam1 = pose;
  for (size_t i = 0; i < 3; ++i) {
    Correspondence& match = problem.matches[i];
    const Eigen::Vector4d u = EvaluateConstraint(F, match).gradient.normalized();
    match.x1_px += off_px[i] * u.head<2>();
    match.x2_px += off_px[i] * u.tail<2>();
    estimate.inliers.push_back(static_cast<int>(i));
  }
  const ResidualProducts products = SumProducts(problem, estimate);
  EXPECT_EQ(products.counts, (std::array<double, kNumDistances>{3.0, 0.0, 0.0, 0.0}));
  EXPECT_NEAR(products.sums[0], -1.0, 0.02);
}

}  // namespace
}  // namespace rcme
