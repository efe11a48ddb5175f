#include "estimator/uncertainty/motion_covariance.h"

#include <Eigen/Cholesky>
#include <Eigen/Jacobi>
#include <Eigen/QR>
#include <cmath>

#include "estimator/geometry/sampson.h"

namespace rcme {

double ConstraintVariance(const Eigen::Matrix3d& F, const Correspondence& match, double sigma_px) {
  return sigma_px * sigma_px * EvaluateConstraint(F, match).squared_gradient();
}

Eigen::Matrix<double, 5, 9> MotionJacobian(const RelativePose& pose) {
  const std::array<Eigen::Matrix3d, 5> dE_dp = EssentialTangent(pose);
  Eigen::Matrix<double, 9, 5> tangent;
  for (int k = 0; k < 5; ++k) tangent.col(k) = Vectorize(dE_dp[static_cast<size_t>(k)]) / std::sqrt(2.0);
  const Matrix5d gram = tangent.transpose() * tangent;
  return gram.ldlt().solve(tangent.transpose());
}

// Sigma_p (eq::cov_p).
Matrix5d CovarianceOfMotion(const RelativePose& pose, const Matrix9d& f_cov) {
  const Eigen::Matrix<double, 5, 9> J_p = MotionJacobian(pose);
  return J_p * f_cov * J_p.transpose();
}

// For five matches: the exact case (eq. 5), carried on to the motion.
std::optional<Matrix5d> FirstOrderMotionCovariance(const RelativePose& pose, const Camera& camera1,
                                                   const Camera& camera2,
                                                   std::span<const Correspondence> matches, double sigma_px) {
  if (matches.size() < 5) return std::nullopt;
  const Eigen::Matrix3d F = FundamentalFromEssential(EssentialFromPose(pose), camera1, camera2);
  std::array<Eigen::Matrix3d, 5> dF_dp = EssentialTangent(pose);
  for (Eigen::Matrix3d& derivative : dF_dp)
    derivative = FundamentalFromEssential(derivative, camera1, camera2);

  // The triangle of the QR factorization of the whitened rows, updated row by row with plane rotations. root'
  // root is the information, but its condition number is not squared.
  Matrix5d root = Matrix5d::Zero();
  for (const Correspondence& match : matches) {
    const double variance = sigma_px * sigma_px * EvaluateConstraint(F, match).squared_gradient();
    if (!(variance > 0.0 && std::isfinite(variance))) return std::nullopt;
    Eigen::Matrix<double, 1, 5> row;
    for (int i = 0; i < 5; ++i) {
      row(i) = EvaluateConstraint(dF_dp[static_cast<size_t>(i)], match).g / std::sqrt(variance);
    }
    for (int i = 0; i < 5; ++i) {
      Eigen::JacobiRotation<double> rotation;
      rotation.makeGivens(root(i, i), row(i));
      const Eigen::Matrix<double, 1, 5> above = root.row(i);
      root.row(i) = rotation.c() * above - rotation.s() * row;
      row = rotation.s() * above + rotation.c() * row;
    }
  }
  const Eigen::ColPivHouseholderQR<Matrix5d> qr(root);
  if (!(std::abs(qr.matrixQR()(4, 4)) > 1e-9 * std::abs(qr.matrixQR()(0, 0)))) return std::nullopt;
  const Matrix5d root_inverse = qr.inverse();
  const Matrix5d pose_cov = root_inverse * root_inverse.transpose();
  if (!pose_cov.allFinite()) return std::nullopt;
  return pose_cov;
}

Eigen::Matrix<double, 7, 7> CovarianceOfQuaternionAndTranslation(const RelativePose& pose,
                                                                 const Matrix5d& pose_cov) {
  const Eigen::Matrix<double, 7, 5> jacobian = QuaternionAndTranslationJacobian(pose);
  return jacobian * pose_cov * jacobian.transpose();
}

}  // namespace rcme
