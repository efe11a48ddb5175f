// The descent on costs that are made up: half the square of the distance from a motion, seen wrongly.
#include "estimator/refinement/motion_search.h"

#include <gtest/gtest.h>

namespace rcme {
namespace {

const RelativePose kOptimum = {RotationFromVector({0.1, -0.2, 0.3}), Eigen::Vector3d(0.6, 0.0, 0.8)};

RelativePose Start() {
  Vector5d off;
  off << 0.02, -0.01, 0.015, 0.01, -0.02;
  return Retract(kOptimum, off);
}

// The cost of 1e4 |x|^2 / 2, x the optimum as seen from the motion; its Hessian times `curvature`.
NormalEquations CostAt(const RelativePose& pose, double curvature) {
  const Vector5d x = LocalCoordinates(pose, kOptimum);
  return {0.5e4 * x.squaredNorm(), -1e4 * x, 1e4 * curvature * Matrix5d::Identity()};
}

RefinedMotion Descend(const std::function<NormalEquations(const RelativePose&)>& linearize) {
  return MinimizeOverMotion(
      Start(), {linearize, [](const RelativePose&) { return Matrix5d(1e4 * Matrix5d::Identity()); }});
}

double DistanceFromOptimum(const RefinedMotion& motion) {
  return LocalCoordinates(kOptimum, motion.cam2_from_cam1).norm();
}

// A Hessian that is too small makes steps 2.5 times too long, which would lead away from the optimum by half
// as much again each time: none of them may be taken.
TEST(MinimizeOverMotion, TakesNoStepUphill) {
  const RefinedMotion refined = Descend([](const RelativePose& pose) { return CostAt(pose, 0.4); });
  EXPECT_TRUE(refined.converged);
  EXPECT_LT(DistanceFromOptimum(refined), 1e-5);
}

// Six refused steps damp the next ones by 100; they find back to Newton's in as many, and end long before the
// limit. With the damping kept, the rest of the way would shrink by a hundredth a step.
TEST(MinimizeOverMotion, DampingRelaxesAgain) {
  int num_calls = 0;
  const RefinedMotion refined = Descend([&](const RelativePose& pose) {
    NormalEquations equations = CostAt(pose, 1.0);
    if (num_calls > 0 && num_calls <= 6) equations.cost = 1e9;
    ++num_calls;
    return equations;
  });
  EXPECT_TRUE(refined.converged);
  EXPECT_LT(DistanceFromOptimum(refined), 1e-5);
  EXPECT_LT(refined.num_iterations, 20);
}

}  // namespace
}  // namespace rcme
