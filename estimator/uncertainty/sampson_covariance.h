#pragma once

#include "estimator/geometry/sampson.h"

namespace rcme {

// Sigma_delta = J_X sigma^2 J_X' + J_p Sigma_p J_p' (eq::cov_sampson_error_vec), 4x4, px^2, with the
// Jacobians at the measured point as printed. Rank one at g = 0, nearly singular elsewhere. The loop instead
// uses the closed forms of point_consistency.h, which the tests compare with this one.
Eigen::Matrix4d CovarianceOfSampsonVector(const Eigen::Matrix3d& F,
                                          const std::array<Eigen::Matrix3d, 5>& dF_dp,
                                          const Matrix5d& pose_cov, double sigma_px,
                                          const Correspondence& match);

}  // namespace rcme
