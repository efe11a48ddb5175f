#include "estimator/uncertainty/svd_differential.h"

namespace rcme {

// The J_p of Sigma_p (eq::cov_p).
//
// F = U S V' with rotations U, V and S = diag(s1, s2, s3), s3 of either sign. With the skew matrices Omega_U
// = U' dU, Omega_V = V' dV and Q = U' dF V,
//
//   dF = dU S V' + U dS V' + U S dV'   =>   Q = Omega_U S + dS - S Omega_V.
//
// The entries (i, j) and (j, i), i != j, are two equations in Omega_U,ij and Omega_V,ij,
//
//   Q_ij = s_j Omega_U,ij - s_i Omega_V,ij         Omega_U,ij = (s_j Q_ij + s_i Q_ji) / (s_j^2 - s_i^2)
//   Q_ji = s_j Omega_V,ij - s_i Omega_U,ij   =>    Omega_V,ij = (s_i Q_ij + s_j Q_ji) / (s_j^2 - s_i^2).
//
// R = U W V', W a quarter turn (or back) about e3, moves by dR R' = U (Omega_U - W Omega_V W') U', a rotation
// by the vector w = U (omega_U - W omega_V), omega = (Omega_32, Omega_13, Omega_21). W mixes the first two
// entries of omega_V and keeps the third, where
//
//   Omega_U,21 - Omega_V,21 = (Q_21 - Q_12) (s1 - s2) / (s1^2 - s2^2) = (Q_21 - Q_12) / (s1 + s2).
//
// A common turn of U and V about e3, which is undetermined at s1 = s2, cancels in R. It also cancels in t =
// +-U e3: dt = +-U (omega_U x e3).
Eigen::Matrix<double, 5, 9> MotionJacobianBySvd(const EssentialProjection& projection,
                                                const RelativePose& pose) {
  const Eigen::Matrix3d &U = projection.U, &V = projection.V;
  const double s1 = projection.singular_values(0), s2 = projection.singular_values(1),
               s3 = projection.singular_values(2);
  // Identifies the motion among the four: W turns by +90 deg (W_21 = 1) or by -90 deg (W_21 = -1), and t = u3
  // or -u3.
  const double turn = (U.transpose() * pose.R * V)(1, 0) > 0.0 ? 1.0 : -1.0;
  const double side = U.col(2).dot(pose.t) > 0.0 ? 1.0 : -1.0;
  const Eigen::Matrix<double, 2, 3> to_tangent = DirectionBasis(pose.t).transpose() * (side * U);

  Eigen::Matrix<double, 5, 9> jacobian;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col) {
      const Eigen::Matrix3d Q = U.row(row).transpose() * V.row(col);  // of dF = e_row e_col'
      const double d23 = s2 * s2 - s3 * s3, d13 = s1 * s1 - s3 * s3;
      const double omega_U_1 = (s2 * Q(2, 1) + s3 * Q(1, 2)) / d23;
      const double omega_V_1 = (s3 * Q(2, 1) + s2 * Q(1, 2)) / d23;
      const double omega_U_2 = -(s3 * Q(0, 2) + s1 * Q(2, 0)) / d13;
      const double omega_V_2 = -(s1 * Q(0, 2) + s3 * Q(2, 0)) / d13;
      const Eigen::Vector3d w(omega_U_1 + turn * omega_V_2, omega_U_2 - turn * omega_V_1,
                              (Q(1, 0) - Q(0, 1)) / (s1 + s2));
      jacobian.col(3 * row + col) << U * w, to_tangent * Eigen::Vector3d(omega_U_2, -omega_U_1, 0.0);
    }
  }
  return jacobian;
}

}  // namespace rcme
