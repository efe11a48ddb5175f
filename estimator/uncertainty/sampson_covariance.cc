#include "estimator/uncertainty/sampson_covariance.h"

namespace rcme {

// Sigma_delta (eq::cov_sampson_error_vec).
Eigen::Matrix4d CovarianceOfSampsonVector(const Eigen::Matrix3d& F,
                                          const std::array<Eigen::Matrix3d, 5>& dF_dp,
                                          const Matrix5d& pose_cov, double sigma_px,
                                          const Correspondence& match) {
  const Eigen::Matrix4d J_X = SampsonVectorPointJacobian(F, match);
  const Eigen::Matrix<double, 4, 5> J_p = SampsonVectorPoseJacobian(F, dF_dp, match);
  return sigma_px * sigma_px * J_X * J_X.transpose() + J_p * pose_cov * J_p.transpose();
}

}  // namespace rcme
