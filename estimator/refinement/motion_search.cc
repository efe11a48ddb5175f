#include "estimator/refinement/motion_search.h"

#include <Eigen/Cholesky>

namespace rcme {
namespace {

constexpr int kMaxIterations = 50;
constexpr double kNegligibleDecrease = 1e-9;

}  // namespace

RefinedMotion MinimizeOverMotion(const RelativePose& start,
                                 const std::function<NormalEquations(const RelativePose&)>& linearize) {
  RefinedMotion result{.cam2_from_cam1 = start};
  NormalEquations at = linearize(start);
  double damping = 1e-3;
  for (; result.num_iterations < kMaxIterations; ++result.num_iterations) {
    Matrix5d damped = at.hessian;
    damped.diagonal() *= 1.0 + damping;
    const Vector5d step = -damped.ldlt().solve(at.gradient);
    if (!step.allFinite()) break;
    const RelativePose moved = Retract(result.cam2_from_cam1, step);
    if (damping < 1.0 && -step.dot(at.gradient) < kNegligibleDecrease) {  // the last step needs no other look
      result.cam2_from_cam1 = moved;
      result.converged = true;
      break;
    }
    const NormalEquations there = linearize(moved);
    if (there.cost < at.cost) {
      result.cam2_from_cam1 = moved;
      at = there;
      damping *= 0.1;
    } else {
      damping *= 10.0;
    }
  }
  const Eigen::LLT<Matrix5d> llt(at.information);
  if (!result.converged || llt.info() != Eigen::Success) return {.cam2_from_cam1 = start};
  result.pose_cov = llt.solve(Matrix5d::Identity());
  return result;
}

}  // namespace rcme
