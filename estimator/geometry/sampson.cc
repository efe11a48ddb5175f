#include "estimator/geometry/sampson.h"

#include <Eigen/Geometry>

namespace rcme {

EpipolarConstraint EvaluateConstraint(const Eigen::Matrix3d& F, const Correspondence& match) {
  const Eigen::Vector3d line_in_2 = F * match.x1_px.homogeneous();              // epipolar line of x1
  const Eigen::Vector3d line_in_1 = F.transpose() * match.x2_px.homogeneous();  // epipolar line of x2
  EpipolarConstraint constraint;
  constraint.g = match.x2_px.homogeneous().dot(line_in_2);
  constraint.gradient << line_in_1.head<2>(), line_in_2.head<2>();
  return constraint;
}

Eigen::Matrix4d ConstraintHessian(const Eigen::Matrix3d& F) {
  Eigen::Matrix4d H = Eigen::Matrix4d::Zero();
  H.topRightCorner<2, 2>() = F.topLeftCorner<2, 2>().transpose();
  H.bottomLeftCorner<2, 2>() = F.topLeftCorner<2, 2>();
  return H;
}

double SquaredSampsonDistance(const Eigen::Matrix3d& F, const Correspondence& match) {
  const EpipolarConstraint constraint = EvaluateConstraint(F, match);
  return constraint.g * constraint.g / constraint.squared_gradient();
}

// delta (eq::sampson_error_vec).
Eigen::Vector4d SampsonVector(const Eigen::Matrix3d& F, const Correspondence& match) {
  const EpipolarConstraint constraint = EvaluateConstraint(F, match);
  return -constraint.g / constraint.squared_gradient() * constraint.gradient;
}

// J_X of Sigma_delta (eq::cov_sampson_error_vec).
Eigen::Matrix4d SampsonVectorPointJacobian(const Eigen::Matrix3d& F, const Correspondence& match) {
  const EpipolarConstraint c = EvaluateConstraint(F, match);
  const double n2 = c.squared_gradient();
  const Eigen::Matrix4d H = ConstraintHessian(F);
  const Eigen::RowVector4d J = c.gradient.transpose();
  return -(c.gradient * J + c.g * H - (2.0 * c.g / n2) * c.gradient * (J * H)) / n2;
}

// J_p of Sigma_delta (eq::cov_sampson_error_vec).
Eigen::Matrix<double, 4, 5> SampsonVectorPoseJacobian(const Eigen::Matrix3d& F,
                                                      const std::array<Eigen::Matrix3d, 5>& dF_dp,
                                                      const Correspondence& match) {
  const EpipolarConstraint c = EvaluateConstraint(F, match);
  const double n2 = c.squared_gradient();
  Eigen::Matrix<double, 1, 5> g_p;
  Eigen::Matrix<double, 4, 5> J_p;
  for (int k = 0; k < 5; ++k) {
    const EpipolarConstraint derivative =
        EvaluateConstraint(dF_dp[static_cast<size_t>(k)], match);  // linear in F
    g_p(k) = derivative.g;
    J_p.col(k) = derivative.gradient;
  }
  return -(c.gradient * g_p + c.g * J_p - (2.0 * c.g / n2) * c.gradient * (c.gradient.transpose() * J_p)) /
         n2;
}

}  // namespace rcme
