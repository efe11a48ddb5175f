// The essential matrix E = [t]x R with x2' E x1 = 0 in rays. Matrices become vectors row by row, like the
// paper's f.
#pragma once

#include <Eigen/Core>
#include <array>

#include "estimator/geometry/camera.h"
#include "estimator/geometry/pose.h"

namespace rcme {

using Vector9d = Eigen::Matrix<double, 9, 1>;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

// Row-major 9-vector of a 3x3 matrix, and back.
Vector9d Vectorize(const Eigen::Matrix3d& matrix);
Eigen::Matrix3d Matricize(const Vector9d& vector);

// E = [t]x R, Frobenius norm sqrt(2).
Eigen::Matrix3d EssentialFromPose(const RelativePose& pose);

// dE/dp for the tangent [rotation 3, direction 2]: dE/dw_k = [t]x [e_k]x R, dE/db_k = [B_k]x R.
std::array<Eigen::Matrix3d, 5> EssentialTangent(const RelativePose& pose);

// F = K2^-T E K1^-1 with x2' F x1 = 0 in pixels (eq::model_motion_relation, with a camera matrix for each
// image). The map is linear, so it also maps derivatives of E.
Eigen::Matrix3d FundamentalFromEssential(const Eigen::Matrix3d& E, const Camera& camera1,
                                         const Camera& camera2);

// A 3x3 matrix U diag(s) V' and the nearest essential matrix U diag(1, 1, 0) V' in Frobenius norm (both up to
// scale). This projection takes the linear 8-point solution to E, in ray coordinates rather than Hartley's.
struct EssentialProjection {
  Eigen::Matrix3d U, V;             // proper rotations
  Eigen::Vector3d singular_values;  // descending; the last has the sign of the determinant

  // False if the second singular value is zero: then the direction of translation is undetermined.
  bool DeterminesDirection() const { return singular_values(1) > 1e-9 * singular_values(0); }
};
EssentialProjection ProjectToEssential(const Eigen::Matrix3d& matrix);

// The four poses of an essential matrix, {R_a, R_b} x {t, -t}. They are the solutions p of Theta(f, p) = 0
// (eq::motion_estimate) for the essential matrix nearest to f.
std::array<RelativePose, 4> PosesFromEssential(const EssentialProjection& projection);

}  // namespace rcme
