// The epipolar constraint of one correspondence and its Sampson correction, in pixels.
#pragma once

#include <Eigen/Core>

#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/essential_matrix.h"

namespace rcme {

// g = x2' F x1 at X = [x1; x2] (px) and its derivatives with respect to X.
struct EpipolarConstraint {
  double g = 0.0;
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();  // J' = (dg/dX)', 4x1
  double squared_gradient() const { return gradient.squaredNorm(); }
};
EpipolarConstraint EvaluateConstraint(const Eigen::Matrix3d& F, const Correspondence& match);

// H = d2g/dX2 (4x4, the same for every X): off-diagonal blocks F[0:2, 0:2]' and F[0:2, 0:2].
Eigen::Matrix4d ConstraintHessian(const Eigen::Matrix3d& F);

// Squared Sampson distance g^2 / |J|^2, px^2: the squared length of the Sampson vector.
double SquaredSampsonDistance(const Eigen::Matrix3d& F, const Correspondence& match);

// delta = -J' g / |J|^2, px (eq::sampson_error_vec).
Eigen::Vector4d SampsonVector(const Eigen::Matrix3d& F, const Correspondence& match);

// d delta / dX, 4x4 = -[J'J + g H - 2 (g / |J|^2) J' (J H)] / |J|^2.
Eigen::Matrix4d SampsonVectorPointJacobian(const Eigen::Matrix3d& F, const Correspondence& match);

// d delta / dp, 4x5 = -[J' g_p + g J_p - 2 (g / |J|^2) J' (J J_p)] / |J|^2, where dF_dp are the five
// derivatives of F, g_p = dg/dp (1x5) and J_p = dJ'/dp (4x5).
Eigen::Matrix<double, 4, 5> SampsonVectorPoseJacobian(const Eigen::Matrix3d& F,
                                                      const std::array<Eigen::Matrix3d, 5>& dF_dp,
                                                      const Correspondence& match);

}  // namespace rcme
