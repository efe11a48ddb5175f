#include "estimator/calibrated/whitened_problem.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace rcme {
namespace {

// The turned camera, and how its pixels and rays follow from those of the original one.
struct TurnedCamera {
  Camera camera;
  Eigen::Matrix3d turn;       // T
  Eigen::Matrix2d of_pixels;  // from the offset from the original principal point to that from the new one
};
// Of the axes of the noise in either order and sign, those nearest to `near`.
TurnedCamera Turn(const Camera& camera, const Eigen::Matrix2d& shape, const Eigen::Matrix2d& near) {
  const Eigen::Vector2d inverse_focal(1.0 / camera.fx, 1.0 / camera.fy);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(inverse_focal.asDiagonal() * shape *
                                                             inverse_focal.asDiagonal());
  Eigen::Matrix2d axes = eigen.eigenvectors();
  Eigen::Vector2d focal = eigen.eigenvalues().cwiseSqrt().cwiseInverse();
  if (std::abs(near.col(0).dot(axes.col(0))) < std::abs(near.col(0).dot(axes.col(1)))) {
    axes.col(0).swap(axes.col(1));
    std::swap(focal(0), focal(1));
  }
  for (int k = 0; k < 2; ++k)
    if (near.col(k).dot(axes.col(k)) < 0.0) axes.col(k) *= -1.0;
  TurnedCamera turned{camera, Eigen::Matrix3d::Identity(),
                      focal.asDiagonal() * axes.transpose() * inverse_focal.asDiagonal()};
  turned.turn.topLeftCorner<2, 2>() = axes.transpose();
  turned.camera.fx = focal(0);
  turned.camera.fy = focal(1);
  const double longer = std::pow(shape.determinant(), -0.25);  // lengths of the image, as its area grows
  turned.camera.width = static_cast<int>(std::lround(longer * camera.width));
  turned.camera.height = static_cast<int>(std::lround(longer * camera.height));
  return turned;
}

Eigen::Vector2d MapPixel(const Camera& from, const TurnedCamera& to, const Eigen::Vector2d& x_px) {
  const Eigen::Vector2d centre_from(from.cx, from.cy), centre_to(to.camera.cx, to.camera.cy);
  return centre_to + to.of_pixels * (x_px - centre_from);
}

MotionPrior TurnPrior(MotionPrior prior, const Eigen::Matrix3d& turn1, const Eigen::Matrix3d& turn2) {
  if (prior.rotation) {
    prior.rotation->R = turn2 * prior.rotation->R * turn1.transpose();
    prior.rotation->cov = turn2 * prior.rotation->cov * turn2.transpose();
  }
  if (prior.gravity) {
    prior.gravity->in_cam1 = turn1 * prior.gravity->in_cam1;
    prior.gravity->in_cam2 = turn2 * prior.gravity->in_cam2;
  }
  if (prior.direction) prior.direction->t = turn2 * prior.direction->t;
  return prior;
}

}  // namespace

WhitenedProblem::WhitenedProblem(const MotionProblem& problem, const Eigen::Matrix2d& shape)
    : problem_(problem) {
  const Eigen::Matrix2d scaled = 2.0 / shape.trace() * shape;
  const TurnedCamera camera1 = Turn(problem.camera1, scaled, Eigen::Matrix2d::Identity());
  const Eigen::Matrix2d axes1 = camera1.turn.topLeftCorner<2, 2>().transpose();
  const TurnedCamera camera2 = Turn(problem.camera2, scaled, axes1);
  of_pixels1_ = camera1.of_pixels;
  of_pixels2_ = camera2.of_pixels;
  problem_.camera1 = camera1.camera;
  problem_.camera2 = camera2.camera;
  turn1_ = camera1.turn;
  turn2_ = camera2.turn;
  for (Correspondence& match : problem_.matches) {
    match.x1_px = MapPixel(problem.camera1, camera1, match.x1_px);
    match.x2_px = MapPixel(problem.camera2, camera2, match.x2_px);
  }
  if (problem.prior) problem_.prior = TurnPrior(*problem.prior, turn1_, turn2_);
}

RelativePose WhitenedProblem::Restored(const RelativePose& pose) const {
  return {turn2_.transpose() * pose.R * turn1_, turn2_.transpose() * pose.t};
}

Matrix5d WhitenedProblem::TangentMap(const RelativePose& whitened) const {
  Matrix5d map = Matrix5d::Zero();
  map.topLeftCorner<3, 3>() = turn2_.transpose();
  map.bottomRightCorner<2, 2>() =
      DirectionBasis(Restored(whitened).t).transpose() * turn2_.transpose() * DirectionBasis(whitened.t);
  return map;
}

void WhitenedProblem::Restore(MotionEstimate* estimate) const {
  const auto restore = [&](RelativePose* pose, Matrix5d* covariance) {
    const Matrix5d map = TangentMap(*pose);
    *pose = Restored(*pose);
    *covariance = map * *covariance * map.transpose();
  };
  for (Matrix5d* each : {&estimate->pose_cov_without_errors, &estimate->pose_cov_with_errors}) {
    RelativePose same = estimate->cam2_from_cam1;
    restore(&same, each);
  }
  restore(&estimate->cam2_from_cam1, &estimate->pose_cov);
  estimate->initial_pose = Restored(estimate->initial_pose);
  for (MotionMode& mode : estimate->other_modes) restore(&mode.cam2_from_cam1, &mode.pose_cov);
}

void WhitenedProblem::Restore(MotionPosterior* posterior) const {
  const Eigen::Vector3d t = posterior->answer.t;
  posterior->answer = Restored(posterior->answer);
  for (MotionComponent& component : posterior->components) {
    const Matrix5d map = TangentMap(component.mean);
    component.mean = Restored(component.mean);
    component.covariance = map * component.covariance * map.transpose();
  }
  // Azimuths count from unitOrthogonal of the answer's direction.
  const Eigen::Vector3d u = turn2_.transpose() * t.unitOrthogonal(), now = posterior->answer.t;
  const Eigen::Vector3d u_now = now.unitOrthogonal();
  const double azimuth = std::atan2(u.dot(now.cross(u_now)), u.dot(u_now));
  for (DirectionCell& cell : posterior->cells) {
    cell.azimuth_low += azimuth;
    cell.azimuth_high += azimuth;
    cell.rotation = turn2_.transpose() * cell.rotation;
    cell.rotation_cov = turn2_.transpose() * cell.rotation_cov * turn2_;
  }
}

}  // namespace rcme
