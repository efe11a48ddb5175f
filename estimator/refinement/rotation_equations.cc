#include "estimator/refinement/rotation_equations.h"

#include <Eigen/LU>
#include <optional>

namespace rcme {
namespace {

struct Transfer {
  Eigen::Vector2d e;              // px
  Eigen::Matrix2d information;    // C^-1, 1 / px^2
  Eigen::Matrix<double, 2, 3> G;  // dh/dw, px / rad
  double d2;
};

// nullopt behind camera 2. With y = R ray1, h(y) = [fx y0 / y2 + cx, fy y1 / y2 + cy]; w moves y by w x y.
std::optional<Transfer> EvaluateTransfer(const MotionProblem& problem, const Eigen::Matrix3d& R,
                                         const Correspondence& match) {
  const Camera &camera1 = problem.camera1, &camera2 = problem.camera2;
  const Eigen::Vector3d y = R * camera1.Ray(match.x1_px);
  if (!(y.z() > 0.0)) return std::nullopt;
  Eigen::Matrix<double, 2, 3> dh_dy;
  dh_dy << camera2.fx / y.z(), 0.0, -camera2.fx * y.x() / (y.z() * y.z()),  //
      0.0, camera2.fy / y.z(), -camera2.fy * y.y() / (y.z() * y.z());
  const Eigen::Matrix2d J =
      dh_dy * R.leftCols<2>() * Eigen::Vector2d(1.0 / camera1.fx, 1.0 / camera1.fy).asDiagonal();
  const Eigen::Matrix2d C =
      problem.sigma_px * problem.sigma_px * (Eigen::Matrix2d::Identity() + J * J.transpose());
  Transfer transfer{match.x2_px - camera2.Project(y), C.inverse(), -dh_dy * CrossMatrix(y), 0.0};
  transfer.d2 = transfer.e.dot(transfer.information * transfer.e);
  return transfer;
}

}  // namespace

RotationEquations LinearizeRotation(const MotionProblem& problem, std::span<const int> indices,
                                    const Eigen::Matrix3d& R, Loss loss) {
  RotationEquations equations;
  for (const int i : indices) {
    const auto transfer = EvaluateTransfer(problem, R, problem.matches[static_cast<size_t>(i)]);
    if (!transfer) continue;
    const double weight =
        loss == Loss::kCauchy ? 1.0 / (1.0 + transfer->d2 / (kCauchyScale * kCauchyScale)) : 1.0;
    const Eigen::Matrix<double, 3, 2> weighted = weight * transfer->G.transpose() * transfer->information;
    equations.energy += transfer->d2;
    equations.gradient -= weighted * transfer->e;
    equations.hessian += weighted * transfer->G;
  }
  return equations;
}

std::vector<int> FindRotated(const MotionProblem& problem, const Eigen::Matrix3d& R, double threshold) {
  std::vector<int> found;
  for (int i = 0; i < static_cast<int>(problem.matches.size()); ++i) {
    const auto transfer = EvaluateTransfer(problem, R, problem.matches[static_cast<size_t>(i)]);
    if (transfer && transfer->d2 <= threshold) found.push_back(i);
  }
  return found;
}

}  // namespace rcme
