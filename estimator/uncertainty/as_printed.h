// The paper's formulas exactly as printed, where the estimator computes the same number, or the correct one,
// in another way. The claim audit compares the two.
#pragma once

#include <Eigen/Core>
#include <span>

#include "estimator/geometry/correspondence.h"
#include "estimator/geometry/essential_matrix.h"

namespace rcme {

// J_Omega' Sigma_X^-1 J_Omega (9x9) of m matches for f (unit, in rays), with J_Omega (4m x 9) the
// minimum-norm implicit derivative -(dg/dX)^+ (dg/df) of each match. Rank min(m, 8).
Matrix9d SampleInformation(const Vector9d& f, const Camera& camera1, const Camera& camera2,
                           std::span<const Correspondence> matches, double sigma_px);

// A (A' I A)^-1 A' of an information matrix I (9x9) and A (9x8): Sigma_f, overdetermined case (eq. 6).
Matrix9d OverdeterminedCovariance(const Matrix9d& information, const Eigen::Matrix<double, 9, 8>& A);

// The first eight columns of the Householder matrix I - 2 v v' / v'v that reflects the unit vector f onto the
// axis `onto` (0..8). They are normal to f only for the last axis.
Eigen::Matrix<double, 9, 8> HouseholderColumns(const Vector9d& f, int onto);

// delta' Sigma^+ delta with the pseudo-inverse of rank one, the rank of Sigma_delta to first order.
double RankOneDistance(const Eigen::Vector4d& delta, const Eigen::Matrix4d& delta_cov);

}  // namespace rcme
