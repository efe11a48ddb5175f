// Travel along the optical axis, seen with noise of a given shape. The epipolar lines meet in the image and
// have every direction, so that the shape can be seen in the residuals.
#pragma once

#include <Eigen/Cholesky>

#include "tests/test_support/random_problem.h"

namespace rcme {

// `shape`: the covariance of a point's noise (px^2, in both images) over 0.25, with a trace of 2.
inline RandomProblem ForwardProblem(int num_matches, const Eigen::Matrix2d& shape, RandomStream& rng) {
  constexpr double kSigmaPx = 0.5;
  const Camera camera1 = TestCamera1(), camera2 = TestCamera2();
  RandomProblem random;
  random.pose_true = {RotationFromVector({0.02, -0.03, 0.01}),
                      Eigen::Vector3d(0.05, -0.05, -1.0).normalized()};
  random.problem.camera1 = camera1;
  random.problem.camera2 = camera2;
  random.problem.sigma_px = kSigmaPx;
  const Eigen::Matrix2d root = kSigmaPx * Eigen::Matrix2d(shape.llt().matrixL());
  while (static_cast<int>(random.problem.matches.size()) < num_matches) {
    const std::optional<Eigen::Vector3d> point = RandomPoint(random.pose_true, camera1, camera2, {}, rng);
    if (!point) continue;
    Correspondence match = ProjectToBoth(*point, random.pose_true, camera1, camera2);
    match.x1_px += root * Eigen::Vector2d(rng.Normal(), rng.Normal());
    match.x2_px += root * Eigen::Vector2d(rng.Normal(), rng.Normal());
    random.points_in_cam1.push_back(*point);
    random.problem.matches.push_back(match);
  }
  return random;
}

}  // namespace rcme
