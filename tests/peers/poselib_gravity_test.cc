// PoseLib's samples of three with gravity, where CMake found PoseLib 3.
#include <gtest/gtest.h>

#include <algorithm>

#include "estimator/geometry/pose.h"
#include "tests/peers/peer_entries.h"
#include "tests/test_support/two_camera_scene.h"

namespace rcme {
namespace {

bool HasPoseLibGravity() {
  return std::ranges::count(PeerEntries(), "poselib_gravity", &EstimatorEntry::name) > 0;
}

MotionEstimate Ask(const std::string& name, const MotionProblem& problem, std::uint32_t trial) {
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 4190});
  return MakeEstimator(name, {{"max_iterations", "300"}, {"min_iterations", "0"}})->Estimate(problem, rng);
}

bool IsNear(const MotionEstimate& estimate, const RelativePose& truth) {
  constexpr double kBoundRad = 0.05;
  return estimate.status == MotionStatus::kOk &&
         AngleBetween(estimate.cam2_from_cam1.t, truth.t) < kBoundRad &&
         RotationAngleBetween(estimate.cam2_from_cam1.R, truth.R) < kBoundRad;
}

// A quarter of the matches are right: none of 300 samples of three is free of wrong ones with a probability
// of 0.009, none of five with 0.75.
TEST(PoseLibGravity, FindsMotionsAmongWrongMatchesThatFivePointsMiss) {
  if (!HasPoseLibGravity()) GTEST_SKIP() << "CMake did not find PoseLib 3";
  int num_near = 0, num_near_of_five = 0;
  for (std::uint32_t trial = 0; trial < 20; ++trial) {
    RelativePose truth;
    MotionProblem problem = TwoCameraProblem(100, 0.5, 0.75, trial, &truth);
    num_near_of_five += IsNear(Ask("poselib_gravity", problem, trial), truth) ? 1 : 0;
    const Eigen::Vector3d down = Eigen::Vector3d(0.2, 0.9, -0.1).normalized();
    problem.prior = MotionPrior{.gravity = GravityPrior{down, truth.R * down, 1e-3, 1e-3}};
    num_near += IsNear(Ask("poselib_gravity", problem, trial), truth) ? 1 : 0;
  }
  EXPECT_GE(num_near, 17);
  EXPECT_LE(num_near_of_five, 12);
}

TEST(PoseLibGravity, WithoutGravityIsPoseLib) {
  if (!HasPoseLibGravity()) GTEST_SKIP() << "CMake did not find PoseLib 3";
  const MotionProblem problem = TwoCameraProblem(100, 0.5, 0.3, 0);
  EXPECT_EQ(Ask("poselib_gravity", problem, 0).cam2_from_cam1.t, Ask("poselib", problem, 0).cam2_from_cam1.t);
}

}  // namespace
}  // namespace rcme
