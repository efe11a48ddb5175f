// First-order covariance: from the noise of the minimal sample to f and to the motion p.
//
// It assumes a.2: independent Gaussian noise of standard deviation sigma_px in each coordinate of each image.
// It is exact in the limit sigma -> 0; for a minimal sample at sigma = 0.5 px it is already too small
// (results/README.md).
#pragma once

#include <optional>
#include <span>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/essential_matrix.h"

namespace rcme {

// Variance of the constraint g = x2' F x1 of a match: sigma^2 |J|^2, F in pixels.
double ConstraintVariance(const Eigen::Matrix3d& F, const Correspondence& match, double sigma_px);

// Sigma_f = G D G' (9x9) of a model with gain G (9 x m), in rays, and constraint variances D (m). With the G
// of ImplicitGain it is the exact case (eq. 5), T Sigma_y T'. For eight points (rank 8, null direction f) it
// equals the paper's overdetermined case A (A' J_Omega' Sigma_X^-1 J_Omega A)^-1 A' (eq. 6) with dOmega/df
// the minimum-norm implicit derivative.
template <int m>
Matrix9d CovarianceOfF(const Eigen::Matrix<double, 9, m>& G,
                       const Eigen::Matrix<double, m, 1>& constraint_variances) {
  return G * constraint_variances.asDiagonal() * G.transpose();
}

// J_p = dp/df (5x9) of the step from the unit vector f to the nearest essential matrix and its motion. It is
// the pseudo-inverse of the unit-norm tangent dE/dp / sqrt(2), which is the paper's -(dTheta/dp)^+ dTheta/df
// on the 5-dimensional manifold. For -f the sign of J_p changes.
Eigen::Matrix<double, 5, 9> MotionJacobian(const RelativePose& pose);

// Sigma_p = J_p Sigma_f J_p' (eq::cov_p), 5x5, [rotation, direction], rad^2.
Matrix5d CovarianceOfMotion(const RelativePose& pose, const Matrix9d& f_cov);

// Sigma_p = (sum_k g_p' g_p / var g_k)^-1 over m matches (5x5, [rotation, direction], rad^2): g_p = dg_k/dp
// (1x5) at `pose`, var g_k = sigma^2 |J_k|^2 at the given matches. It is
//   m = 5: H^-1 D H^-T, H = dg/dp (5x5), D = diag(var g_k): the exact case, delta p = -H^-1 n, whose f has
//          Sigma_f = (J_Omega' Sigma_X^-1 J_Omega)^-1 (eq. 5) on the five tangent directions;
//   m > 5: the covariance of the maximum-likelihood estimate (its point coordinates eliminated) at `pose`;
//   at the true pose and the true points: the Cramer-Rao bound.
// nullopt if there are fewer than five matches, if they do not determine the motion (smallest pivot of the
// whitened dg/dp, mx5, below 1e-9 of the largest), or if sigma_px is 0 or a number is not finite.
std::optional<Matrix5d> FirstOrderMotionCovariance(const RelativePose& pose, const Camera& camera1,
                                                   const Camera& camera2,
                                                   std::span<const Correspondence> matches, double sigma_px);

// The paper's 7x7 covariance of p = [q; t], rank 5.
Eigen::Matrix<double, 7, 7> CovarianceOfQuaternionAndTranslation(const RelativePose& pose,
                                                                 const Matrix5d& pose_cov);

}  // namespace rcme
