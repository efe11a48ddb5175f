#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "estimator/geometry/essential_matrix.h"

namespace rcme {

using Vector8d = Eigen::Matrix<double, 8, 1>;
using Matrix8d = Eigen::Matrix<double, 8, 8>;

// The unit vector f that minimises |M f| (M m x 9, rows kron(x2, x1) in rays), m >= 8, and its sensitivity to
// noise in the constraints. A change dM of M moves the null vector of M'M by -(M'M)^+ (M' dM f + dM' M f). If
// M f = 0 only the first term remains, and with n = dM f
//
//   delta f = -G n,   G = A (M A)^+ (9 x m),   A (9x8) an orthonormal basis of the complement of f.
//
// For m = 8 this is EightPoint's model, and M f = 0 holds always. For m > 8 the neglected term is of second
// order, the product of noise and residual.
struct LinearFit {
  Vector9d f = Vector9d::Zero();
  Eigen::Matrix<double, 9, 8> A = Eigen::Matrix<double, 9, 8>::Zero();
  Eigen::Matrix<double, 9, Eigen::Dynamic> G;
  double conditioning = 0.0;  // smallest over largest singular value of M A, in (0, 1]

  // The coordinates (8) of another unit vector in A, relative to f; zero at +-f.
  Vector8d LocalCoordinates(const Vector9d& other) const;
};

// Linear least squares over all rays with equal weights and no normalisation other than K^-1. nullopt if the
// points do not determine f (conditioning below 1e-9) or a number is not finite.
std::optional<LinearFit> FitLinear(std::span<const Eigen::Vector3d> rays1,
                                   std::span<const Eigen::Vector3d> rays2);

}  // namespace rcme
