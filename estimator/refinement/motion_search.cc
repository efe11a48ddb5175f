#include "estimator/refinement/motion_search.h"

#include <Eigen/Cholesky>
#include <optional>

namespace rcme {
namespace {

constexpr int kMaxIterations = 50;

// The optimum from `start`; nullopt if it is not reached.
std::optional<RelativePose> Descend(const RelativePose& start, const MotionCost& cost, int* num_iterations) {
  RelativePose pose = start;
  NormalEquations at = cost.linearize(pose);
  double damping = 1e-4;
  for (; *num_iterations < kMaxIterations; ++*num_iterations) {
    Matrix5d damped = at.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Vector5d step = -damped.llt().solve(at.gradient);
    if (!step.allFinite()) return std::nullopt;
    const RelativePose moved = Retract(pose, step);
    const double decrease = -0.5 * step.dot(at.gradient);
    if (damping < 1.0 && decrease < cost.negligible_decrease) return moved;  // no further evaluation
    NormalEquations there = cost.linearize(moved);
    if (there.cost < at.cost) {
      pose = moved;
      at = there;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
  }
  return std::nullopt;
}

}  // namespace

RefinedMotion MinimizeOverMotion(const RelativePose& start, const MotionCost& cost) {
  RefinedMotion result{.cam2_from_cam1 = start};
  const std::optional<RelativePose> optimum = Descend(start, cost, &result.num_iterations);
  if (!optimum) return result;
  const Eigen::LLT<Matrix5d> llt(cost.information(*optimum));
  if (llt.info() != Eigen::Success) return result;
  const Matrix5d pose_cov = llt.solve(Matrix5d::Identity());
  if (!pose_cov.allFinite()) return result;
  result.converged = true;
  result.cam2_from_cam1 = *optimum;
  result.pose_cov = pose_cov;
  return result;
}

}  // namespace rcme
