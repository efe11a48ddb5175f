#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "estimator/geometry/essential_matrix.h"

namespace rcme {

using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

// The unit vector f that minimises |M f| (M m x 9, rows kron(x2, x1) in rays), m >= 8, and what noise in the
// constraints does to it. Moving the rows of M moves the null vector of M'M by -(M'M)^+ (M' dM f + dM' M f);
// where M f = 0 only the first term is left, and with n = dM f
//
//   delta f = -G n,   G = A (M A)^+ (9 x m),   A (9x8) an orthonormal basis of the complement of f.
//
// At m = 8 that is EightPoint's model and M f = 0 always; at m > 8 what is left out is of second order, the
// product of noise and residual.
struct LinearFit {
  Vector9d f = Vector9d::Zero();
  Eigen::Matrix<double, 9, 8> A = Eigen::Matrix<double, 9, 8>::Zero();
  Eigen::Matrix<double, 9, Eigen::Dynamic> G;
  double conditioning = 0.0;  // smallest over largest singular value of M A, in (0, 1]

  // Where another vector, of either sign, lies from f: its coordinates in A (8), zero at +-f.
  Vector8d LocalCoordinates(const Vector9d& other) const;
};

// Linear least squares on all rays, equal weights, no normalisation other than K^-1. Nothing if the points do
// not determine f: conditioning below 1e-9, or bad numbers.
std::optional<LinearFit> FitLinear(std::span<const Eigen::Vector3d> rays1,
                                   std::span<const Eigen::Vector3d> rays2);

}  // namespace rcme
