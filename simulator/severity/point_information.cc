#include "simulator/severity/point_information.h"

#include <Eigen/LU>

namespace rcme {
namespace {

// d pixel / d point, 2x3.
Eigen::Matrix<double, 2, 3> ProjectionJacobian(const SceneCamera& camera, const Eigen::Vector3d& point) {
  const double z = point.z();
  Eigen::Matrix<double, 2, 3> J;
  if (camera.HasLens()) {
    const Eigen::Vector2d ray = point.head<2>() / z;
    J << Eigen::Matrix2d::Identity(), -ray;
    return camera.RayJacobian(ray) / z * J;
  }
  J << camera.fx / z, 0.0, -camera.fx * point.x() / (z * z), 0.0, camera.fy / z,
      -camera.fy * point.y() / (z * z);
  return J;
}

// n1 such that n1' (d x1 / d X) = -g', for a g with g' X = 0.
Eigen::Vector2d CancelInImage1(const SceneCamera& camera1, const Eigen::Vector3d& point,
                               const Eigen::Vector3d& g) {
  if (camera1.HasLens()) {
    const Eigen::Matrix2d A = camera1.RayJacobian(point.head<2>() / point.z());
    return -point.z() * A.inverse().transpose() * g.head<2>();
  }
  return {-g.x() * point.z() / camera1.fx, -g.y() * point.z() / camera1.fy};
}

}  // namespace

PointConstraint ComputePointConstraint(const ViewPair& view, const Eigen::Vector3d& X) {
  const RelativePose& pose = view.cam2_from_cam1_true;
  const Eigen::Matrix<double, 2, 3> P2 = ProjectionJacobian(view.camera2, view.InCamera2(X));
  PointConstraint constraint;
  // If the point moves along the ray of x1, that is along X, the first image does not change and the second
  // moves on a line. The second image moves across that line only if x1 moves.
  constraint.line_direction = P2 * (pose.R * X);
  const Eigen::Vector2d n2(-constraint.line_direction.y(), constraint.line_direction.x());
  const Eigen::Vector3d g = (n2.transpose() * P2 * pose.R).transpose();
  constraint.gradient_px << CancelInImage1(view.camera1, X, g), n2;
  const Eigen::RowVector3d n2_P2 = n2.transpose() * P2;
  constraint.gradient_motion << -n2_P2 * CrossMatrix(pose.R * X),
      view.baseline_m * n2_P2 * DirectionBasis(pose.t);
  return constraint;
}

Eigen::Matrix3d ComputeRotationInformation(const ViewPair& view, const Eigen::Vector3d& X, double sigma_px) {
  const Eigen::Matrix3d& R = view.cam2_from_cam1_true.R;
  const Eigen::Matrix<double, 2, 3> P2 = ProjectionJacobian(view.camera2, R * X);
  Eigen::Matrix<double, 2, 4> gradients_px;  // of two numbers: d x2 minus the part due to d x1
  for (int k = 0; k < 2; ++k) {
    gradients_px.row(k) << CancelInImage1(view.camera1, X, (P2.row(k) * R).transpose()).transpose(),
        Eigen::RowVector2d::Unit(k);
  }
  const Eigen::Matrix<double, 2, 3> gradients_rotation = -P2 * CrossMatrix(R * X);
  const Eigen::Matrix2d covariance = sigma_px * sigma_px * gradients_px * gradients_px.transpose();
  return gradients_rotation.transpose() * covariance.inverse() * gradients_rotation;
}

}  // namespace rcme
