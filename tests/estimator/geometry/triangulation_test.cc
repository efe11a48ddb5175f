#include "estimator/geometry/triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "estimator/geometry/essential_matrix.h"
#include "tests/test_support/random_problem.h"

namespace rcme {
namespace {

TEST(InverseDepth, RecoversExactPoints) {
  RandomStream rng({.seed = 1, .purpose = 90});
  for (int i = 0; i < 50; ++i) {
    const RandomProblem random = MakeRandomProblem(rng, {.num_matches = 10, .max_rotation_deg = 40.0});
    for (size_t k = 0; k < random.problem.matches.size(); ++k) {
      const Correspondence& match = random.problem.matches[k];
      const Eigen::Vector3d ray1 = random.problem.camera1.Ray(match.x1_px);
      const Eigen::Vector3d ray2 = random.problem.camera2.Ray(match.x2_px);
      // A point near the epipole has hardly any parallax and loses digits.
      const double parallax = ray2.cross(random.pose_true.t).norm();
      EXPECT_NEAR(InverseDepth(random.pose_true, ray1, ray2), 1.0 / random.points_in_cam1[k].z(),
                  1e-14 / parallax);
      EXPECT_TRUE(IsInFrontOfBothCameras(random.pose_true, ray1, ray2));
    }
  }
}

TEST(InverseDepth, IsTheLeastSquaresSolutionForAnyRays) {
  RandomStream rng({.seed = 1, .purpose = 91});
  for (int i = 0; i < 50; ++i) {
    const RelativePose pose = RandomPose(rng, 180.0);
    const Eigen::Vector3d ray1(rng.Normal(), rng.Normal(), 1.0), ray2(rng.Normal(), rng.Normal(), 1.0);
    const auto cost = [&](double rho) { return ray2.cross(pose.R * ray1 + rho * pose.t).squaredNorm(); };
    const double rho = InverseDepth(pose, ray1, ray2);
    const double h = 1e-3 * (1.0 + std::abs(rho));
    EXPECT_LT(cost(rho), cost(rho + h));
    EXPECT_LT(cost(rho), cost(rho - h));
  }
}

TEST(InverseDepth, PointAtInfinity) {
  RandomStream rng({.seed = 1, .purpose = 92});
  for (int i = 0; i < 20; ++i) {
    const RelativePose pose = RandomPose(rng, 20.0);
    const Eigen::Vector3d ray1(0.3 * rng.Normal(), 0.3 * rng.Normal(), 1.0);
    const Eigen::Vector3d direction = pose.R * ray1;
    const Eigen::Vector3d ray2 = direction / direction.z();
    EXPECT_NEAR(InverseDepth(pose, ray1, ray2), 0.0, 1e-14);
  }
}

TEST(InverseDepth, NoParallaxAtAllIsInfinity) {
  const RelativePose forward{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitZ()};
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(InverseDepth(forward, axis, axis), 0.0);
  EXPECT_FALSE(IsInFrontOfBothCameras(forward, axis, axis));
}

TEST(Cheirality, BehindEitherCameraIsSeen) {
  // Sideways motion t = x; the point (x, 0, z) has rays x / z and (x + 1) / z.
  const RelativePose sideways{Eigen::Matrix3d::Identity(), Eigen::Vector3d::UnitX()};
  const Eigen::Vector3d ray1(0.1, 0.0, 1.0);
  EXPECT_TRUE(IsInFrontOfBothCameras(sideways, ray1, {0.3, 0.0, 1.0}));    // z = 5
  EXPECT_FALSE(IsInFrontOfBothCameras(sideways, ray1, {-0.1, 0.0, 1.0}));  // z = -5, behind both
  // Forward motion by 1 past a point at depth 0.5: in front of camera 1, behind camera 2.
  const RelativePose back{Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitZ()};
  EXPECT_GT(InverseDepth(back, {0.2, 0.0, 1.0}, {-0.2, 0.0, 1.0}), 0.0);
  EXPECT_FALSE(IsInFrontOfBothCameras(back, {0.2, 0.0, 1.0}, {-0.2, 0.0, 1.0}));
}

TEST(Cheirality, PicksTheTruthAmongTheFourPoses) {
  RandomStream rng({.seed = 1, .purpose = 93});
  for (int i = 0; i < 200; ++i) {
    RandomProblem random = MakeRandomProblem(rng, {.num_matches = 20, .max_rotation_deg = 40.0});
    const std::array<RelativePose, 4> poses =
        PosesFromEssential(ProjectToEssential(EssentialFromPose(random.pose_true)));
    const RelativePose exact =
        SelectPoseByCheirality(poses, random.problem.matches, random.problem.camera1, random.problem.camera2);
    EXPECT_LT((exact.R - random.pose_true.R).norm() + (exact.t - random.pose_true.t).norm(), 1e-12);
    AddNoise(1.0, rng, &random.problem);
    const RelativePose noisy =
        SelectPoseByCheirality(poses, random.problem.matches, random.problem.camera1, random.problem.camera2);
    EXPECT_LT((noisy.R - random.pose_true.R).norm() + (noisy.t - random.pose_true.t).norm(), 1e-12);
  }
}

TEST(Cheirality, FirstPoseWinsATie) {
  RandomStream rng({.seed = 1, .purpose = 94});
  const std::array<RelativePose, 2> poses = {RandomPose(rng, 180.0), RandomPose(rng, 180.0)};
  const RelativePose selected = SelectPoseByCheirality(poses, {}, TestCamera1(), TestCamera2());
  EXPECT_EQ(selected.R, poses[0].R);
  EXPECT_EQ(selected.t, poses[0].t);
}

}  // namespace
}  // namespace rcme
