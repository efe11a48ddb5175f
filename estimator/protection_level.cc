#include "estimator/protection_level.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "stats/eigen_solvers.h"
#include "stats/gaussian_norm.h"

namespace rcme {
namespace {

constexpr double kLeastRisk = 1e-12, kRounding = 2e-6;  // of the greatest element of a covariance

void RequireCovariance(const Matrix5d& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!covariance.allFinite()) throw std::invalid_argument("protection level: the covariance is not finite");
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > kRounding * scale)
    throw std::invalid_argument("protection level: the covariance is not symmetric");
  const Eigen::SelfAdjointEigenSolver<Matrix5d> solver(covariance, Eigen::EigenvaluesOnly);
  if (solver.eigenvalues()(0) < -kRounding * scale)
    throw std::invalid_argument("protection level: the covariance is not positive semidefinite");
}

// The level of a block with these eigenvalues; negative ones (rounding) count as 0.
double ComputeLevel(const Eigen::Vector3d& eigenvalues, double tail) {
  return std::min(std::numbers::pi, GaussianNormQuantile(eigenvalues.cwiseMax(0.0), tail));
}

}  // namespace

ProtectionLevels ComputeProtectionLevels(const MotionEstimate& estimate, double risk) {
  if (!(risk >= kLeastRisk && risk < 1.0))
    throw std::invalid_argument(
        fmt::format("protection level: the risk {} is not allowed; give a number in [1e-12, 1)", risk));
  if (estimate.status != MotionStatus::kOk)
    throw std::invalid_argument(fmt::format("protection level: the answer has no motion, its status is {}",
                                            StatusName(estimate.status)));
  const double stated = estimate.failure_probability, p = std::isnan(stated) ? 0.0 : stated;
  if (p < 0.0 || p > 1.0)
    throw std::invalid_argument(
        fmt::format("protection level: the failure probability {} is not in [0, 1]", p));
  const Matrix5d& covariance = estimate.pose_cov;
  RequireCovariance(covariance);
  if (risk <= p) return {std::numbers::pi, std::numbers::pi};
  const double tail = (risk - p) / (1.0 - p);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> rotation(
      Eigen::Matrix3d(covariance.topLeftCorner<3, 3>()), Eigen::EigenvaluesOnly);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> direction(
      Eigen::Matrix2d(covariance.bottomRightCorner<2, 2>()), Eigen::EigenvaluesOnly);
  const Eigen::Vector2d of_direction = direction.eigenvalues();
  return {ComputeLevel(rotation.eigenvalues(), tail),
          ComputeLevel({of_direction(0), of_direction(1), 0.0}, tail)};
}

}  // namespace rcme
