#include "estimator/geometry/pose.h"

#include <Eigen/Geometry>
#include <cmath>

namespace rcme {

Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

Eigen::Matrix3d RotationFromVector(const Eigen::Vector3d& w) {
  const double angle = w.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, w / angle).toRotationMatrix();
}

Eigen::Vector3d VectorFromRotation(const Eigen::Matrix3d& R) {
  const Eigen::AngleAxisd angle_axis(R);
  return angle_axis.angle() * angle_axis.axis();
}

Eigen::Matrix<double, 3, 2> DirectionBasis(const Eigen::Vector3d& t) {
  // The axis least aligned with t, made normal to it, and its cross product with t.
  Eigen::Index least = 0;
  t.cwiseAbs().minCoeff(&least);
  const Eigen::Vector3d first = (Eigen::Vector3d::Unit(least) - t(least) * t).normalized();
  Eigen::Matrix<double, 3, 2> basis;
  basis << first, t.cross(first);
  return basis;
}

RelativePose Retract(const RelativePose& pose, const Vector5d& tangent) {
  const Eigen::Vector3d turn = DirectionBasis(pose.t) * tangent.tail<2>();
  const double angle = turn.norm();
  RelativePose moved;
  moved.R = RotationFromVector(tangent.head<3>()) * pose.R;
  moved.t = angle == 0.0 ? pose.t : (std::cos(angle) * pose.t + std::sin(angle) / angle * turn).normalized();
  return moved;
}

Vector5d LocalCoordinates(const RelativePose& pose, const RelativePose& other) {
  const Eigen::Vector2d sideways =
      DirectionBasis(pose.t).transpose() * other.t;  // sin(angle) times direction
  const double length = sideways.norm();
  const double angle = std::atan2(length, pose.t.dot(other.t));
  Vector5d tangent;
  tangent.head<3>() = VectorFromRotation(other.R * pose.R.transpose());
  if (length > 0.0) {
    tangent.tail<2>() = angle / length * sideways;
  } else {
    tangent.tail<2>() << angle, 0.0;  // the same direction, or the opposite one: any great circle
  }
  return tangent;
}

Matrix5d TransportTangent(const RelativePose& from, const RelativePose& to) {
  if (from.t == to.t) return Matrix5d::Identity();
  const Eigen::Matrix<double, 3, 2> at_from = DirectionBasis(from.t);
  // The rotation that takes from.t to to.t, applied to vectors normal to from.t. Opposite directions are
  // joined by any great circle.
  const double both = 1.0 + from.t.dot(to.t);
  Eigen::Matrix<double, 3, 2> moved = at_from;
  if (both > 1e-12) moved -= (from.t + to.t) * (to.t.transpose() * at_from) / both;
  Matrix5d transport = Matrix5d::Identity();
  transport.bottomRightCorner<2, 2>() = DirectionBasis(to.t).transpose() * moved;
  return transport;
}

double RotationAngleBetween(const Eigen::Matrix3d& R_a, const Eigen::Matrix3d& R_b) {
  return Eigen::AngleAxisd(R_a * R_b.transpose()).angle();
}

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Eigen::Matrix<double, 7, 5> QuaternionAndTranslationJacobian(const RelativePose& pose) {
  // Exp(w) R has the quaternion [1, w/2] * q to first order.
  const Eigen::Quaterniond q(pose.R);
  Eigen::Matrix<double, 7, 5> jacobian = Eigen::Matrix<double, 7, 5>::Zero();
  jacobian.block<1, 3>(0, 0) = -0.5 * q.vec().transpose();
  jacobian.block<3, 3>(1, 0) = 0.5 * (q.w() * Eigen::Matrix3d::Identity() - CrossMatrix(q.vec()));
  jacobian.block<3, 2>(4, 3) = DirectionBasis(pose.t);
  return jacobian;
}

}  // namespace rcme
