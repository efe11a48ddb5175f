#include "estimator/geometry/essential_matrix.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace rcme {

Vector9d Vectorize(const Eigen::Matrix3d& matrix) {
  Vector9d vector;
  vector << matrix.row(0).transpose(), matrix.row(1).transpose(), matrix.row(2).transpose();
  return vector;
}

Eigen::Matrix3d Matricize(const Vector9d& vector) {
  Eigen::Matrix3d matrix;
  matrix << vector.segment<3>(0).transpose(), vector.segment<3>(3).transpose(),
      vector.segment<3>(6).transpose();
  return matrix;
}

Eigen::Matrix3d EssentialFromPose(const RelativePose& pose) { return CrossMatrix(pose.t) * pose.R; }

std::array<Eigen::Matrix3d, 5> EssentialTangent(const RelativePose& pose) {
  const Eigen::Matrix3d t_cross = CrossMatrix(pose.t);
  const Eigen::Matrix<double, 3, 2> basis = DirectionBasis(pose.t);
  std::array<Eigen::Matrix3d, 5> tangent;
  for (int k = 0; k < 3; ++k) {
    tangent[static_cast<size_t>(k)] = t_cross * CrossMatrix(Eigen::Vector3d::Unit(k)) * pose.R;
  }
  tangent[3] = CrossMatrix(basis.col(0)) * pose.R;
  tangent[4] = CrossMatrix(basis.col(1)) * pose.R;
  return tangent;
}

// eq::model_motion_relation.
Eigen::Matrix3d FundamentalFromEssential(const Eigen::Matrix3d& E, const Camera& camera1,
                                         const Camera& camera2) {
  return camera2.InverseK().transpose() * E * camera1.InverseK();
}

// The nearest essential matrix; its four motions solve eq::motion_estimate.
EssentialProjection ProjectToEssential(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  EssentialProjection projection{svd.matrixU(), svd.matrixV(), svd.singularValues()};
  // The last columns of U and V belong to the singular value 0 of E, so their sign is free: make U and V
  // rotations. The matrix remains U diag(s) V' if the last singular value takes the sign.
  for (Eigen::Matrix3d* factor : {&projection.U, &projection.V}) {
    if (factor->determinant() > 0.0) continue;
    factor->col(2) *= -1.0;
    projection.singular_values(2) *= -1.0;
  }
  return projection;
}

std::array<RelativePose, 4> PosesFromEssential(const EssentialProjection& projection) {
  // diag(1, 1, 0) = -Z W = Z W' with Z = [e3]x and W a quarter turn about e3 (Hartley & Zisserman,
  // result 9.19).
  Eigen::Matrix3d W;
  W << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  const Eigen::Matrix3d R_a = projection.U * W * projection.V.transpose();
  const Eigen::Matrix3d R_b = projection.U * W.transpose() * projection.V.transpose();
  const Eigen::Vector3d t = projection.U.col(2);
  return {RelativePose{R_a, t}, RelativePose{R_a, -t}, RelativePose{R_b, t}, RelativePose{R_b, -t}};
}

}  // namespace rcme
