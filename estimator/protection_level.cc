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

// Of a block of a covariance, padded with 0; negative ones (rounding) count as 0.
template <int kSize>
Eigen::Vector3d FindEigenvalues(const Eigen::Matrix<double, kSize, kSize>& block) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, kSize, kSize>> solver(block,
                                                                                  Eigen::EigenvaluesOnly);
  Eigen::Vector3d eigenvalues = Eigen::Vector3d::Zero();
  eigenvalues.head<kSize>() = solver.eigenvalues().cwiseMax(0.0);
  return eigenvalues;
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
  const double errors = estimate.calibration_error_probability,
               weight = errors > 0.0 ? std::min(errors, 1.0) : 0.0;
  const Matrix5d& second = estimate.pose_cov_with_errors;
  const Matrix5d first = CovarianceWithoutErrors(estimate);
  const auto level = [&](const Eigen::Vector3d& without, const Eigen::Vector3d& with) {
    return std::min(std::numbers::pi, GaussianNormQuantile(without, with, weight, tail));
  };
  return {level(FindEigenvalues<3>(first.topLeftCorner<3, 3>()),
                FindEigenvalues<3>(second.topLeftCorner<3, 3>())),
          level(FindEigenvalues<2>(first.bottomRightCorner<2, 2>()),
                FindEigenvalues<2>(second.bottomRightCorner<2, 2>()))};
}

}  // namespace rcme
