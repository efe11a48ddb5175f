#include "estimator/refinement/rotation_mle.h"

#include <Eigen/Cholesky>

namespace rcme {
namespace {

constexpr int kMaxSteps = 10;

}  // namespace

Eigen::Matrix3d MinimizeOverRotation(
    const Eigen::Matrix3d& start, Loss loss,
    const std::function<RotationEquations(const Eigen::Matrix3d& R, Loss loss)>& linearize) {
  const double negligible = loss == Loss::kCauchy ? 1e-2 : 1e-6;
  Eigen::Matrix3d R = start;
  for (int i = 0; i < kMaxSteps; ++i) {
    const RotationEquations at = linearize(R, loss);
    const Eigen::Vector3d step = -at.hessian.llt().solve(at.gradient);
    if (!step.allFinite()) return R;
    R = RotationFromVector(step) * R;
    if (-step.dot(at.gradient) < negligible) return R;
  }
  return R;
}

Eigen::Matrix3d ComputeRotationCovariance(const RotationEquations& equations) {
  return equations.hessian.llt().solve(Eigen::Matrix3d::Identity());
}

}  // namespace rcme
