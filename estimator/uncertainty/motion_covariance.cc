#include "estimator/uncertainty/motion_covariance.h"

#include <Eigen/Cholesky>

#include "estimator/geometry/sampson.h"

namespace rcme {

double ConstraintVariance(const Eigen::Matrix3d& F, const Correspondence& match, double sigma_px) {
  return sigma_px * sigma_px * EvaluateConstraint(F, match).squared_gradient();
}

Eigen::Matrix<double, 8, 1> ConstraintVariances(const Eigen::Matrix3d& F,
                                                std::span<const Correspondence, 8> sample, double sigma_px) {
  Eigen::Matrix<double, 8, 1> variances;
  for (int k = 0; k < 8; ++k) {
    variances(k) = ConstraintVariance(F, sample[static_cast<size_t>(k)], sigma_px);
  }
  return variances;
}

Matrix9d CovarianceOfF(const LinearModel& model, const Eigen::Matrix<double, 8, 1>& constraint_variances) {
  return model.G * constraint_variances.asDiagonal() * model.G.transpose();
}

Matrix9d CovarianceOfF(const Eigen::Matrix<double, 9, Eigen::Dynamic>& G,
                       const Eigen::VectorXd& constraint_variances) {
  return G * constraint_variances.asDiagonal() * G.transpose();
}

Eigen::Matrix<double, 5, 9> MotionJacobian(const RelativePose& pose) {
  const std::array<Eigen::Matrix3d, 5> dE_dp = EssentialTangent(pose);
  Eigen::Matrix<double, 9, 5> tangent;
  for (int k = 0; k < 5; ++k) tangent.col(k) = Vectorize(dE_dp[static_cast<size_t>(k)]) / std::sqrt(2.0);
  const Matrix5d gram = tangent.transpose() * tangent;
  return gram.ldlt().solve(tangent.transpose());
}

Matrix5d CovarianceOfMotion(const RelativePose& pose, const Matrix9d& f_cov) {
  const Eigen::Matrix<double, 5, 9> J_p = MotionJacobian(pose);
  return J_p * f_cov * J_p.transpose();
}

Eigen::Matrix<double, 7, 7> CovarianceOfQuaternionAndTranslation(const RelativePose& pose,
                                                                 const Matrix5d& pose_cov) {
  const Eigen::Matrix<double, 7, 5> jacobian = QuaternionAndTranslationJacobian(pose);
  return jacobian * pose_cov * jacobian.transpose();
}

}  // namespace rcme
