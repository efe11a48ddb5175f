// Two-view motion: a rotation and a direction of translation, a 5-dimensional manifold.
#pragma once

#include <Eigen/Core>

namespace rcme {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

// cam2_from_cam1: a point X1 in camera 1's frame is X2 = R X1 + t in camera 2's. The scale is not observable:
// |t| = 1.
struct RelativePose {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::UnitX();
};

// [v]x, such that [v]x u = v x u.
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v);

// Rotation matrix of the rotation vector w (axis times angle, rad), and back (angle in [0, pi]).
Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& w);
Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& R);

// 3x2 orthonormal basis of the plane normal to the unit vector t: the two tangent directions of the sphere at
// t.
Eigen::Matrix<double, 3, 2> DirectionBasis(const Eigen::Vector3d& t);

// The pose at tangent coordinates [rotation 3, direction 2] (rad) around `pose`: R <- Exp(w) R, and t turned
// by |b| along the great circle in the direction B b, B = DirectionBasis(t). To first order t <- normalise(t
// + B b). Unlike that, the great circle reaches directions more than 90 deg away, so LocalCoordinates is
// finite for every pose.
RelativePose Retract(const RelativePose& pose, const Vector5d& tangent);

// The tangent coordinates of `other` around `pose`: Retract(pose, LocalCoordinates(pose, other)) == other.
Vector5d LocalCoordinates(const RelativePose& pose, const RelativePose& other);

// 5x5. Converts tangent coordinates around `from` into those around `to`: the direction's are moved in
// parallel along the great circle from from.t to to.t, as the bases of the two may differ by a rotation of up
// to 90 deg. The rotation's stay as they are.
Matrix5d TransportTangent(const RelativePose& from, const RelativePose& to);

// Angle (rad, [0, pi]) between two rotations and between two directions.
double RotationAngleBetween(const Eigen::Matrix3d& R_a, const Eigen::Matrix3d& R_b);
double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// The 7x5 Jacobian of the paper's p = [q (w, x, y, z); t] with respect to the tangent: Sigma_p of the paper
// (7x7, rank 5) is J Sigma_5 J'. Never invert it.
Eigen::Matrix<double, 7, 5> QuaternionAndTranslationJacobian(const RelativePose& pose);

}  // namespace rcme
