#include "simulator/severity/severity.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/severity/homography_share.h"
#include "simulator/severity/parallax.h"
#include "simulator/severity/point_information.h"
#include "stats/constants.h"
#include "stats/moments.h"
#include "stats/order_statistic.h"
#include "stats/spatial_pattern.h"

namespace rcme {
namespace {

using Points = std::vector<Eigen::Vector3d>;

double ClarkEvans(const std::vector<Eigen::Vector2d>& pixels, const Camera& camera) {
  return ClarkEvansIndex(pixels, camera.width, camera.height);
}

void MeasureImages(const Scene& scene, const Observation& observation, Severity* severity) {
  std::vector<Eigen::Vector2d> inliers1, outliers1, outliers2;
  for (size_t i = 0; i < observation.matches.size(); ++i) {
    const Correspondence& match = observation.matches[i];
    (observation.is_inlier_true[i] ? inliers1 : outliers1).push_back(match.x1_px);
    if (!observation.is_inlier_true[i]) outliers2.push_back(match.x2_px);
  }
  severity->inlier_clark_evans = ClarkEvans(inliers1, scene.camera1);
  severity->outlier1_clark_evans = ClarkEvans(outliers1, scene.camera1);
  severity->outlier2_clark_evans = ClarkEvans(outliers2, scene.camera2);
  const double image_area = 1.0 * scene.camera1.width * scene.camera1.height;
  severity->image_coverage = ConvexHullArea(std::move(inliers1)) / image_area;
}

void MeasureParallax(const Scene& scene, const Points& points, Severity* severity) {
  std::vector<double> angles_deg = ParallaxesDeg(scene, points);
  severity->parallax_median_deg = ComputeQuantile(angles_deg, 0.5);
  severity->parallax_p10_deg = ComputeQuantile(angles_deg, 0.1);
}

double Planarity(const Points& points) {
  if (points.size() < 4) return kNaN;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& point : points) mean += point;
  mean /= static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points) scatter += (point - mean) * (point - mean).transpose();
  const Eigen::Vector3d eigenvalues = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(scatter).eigenvalues();
  return std::sqrt(std::max(0.0, eigenvalues(0)) / eigenvalues.sum());
}

// Share of image 2 within 1.96 standard deviations of a point's epipolar line; with a lens, of the tangent of
// its curve.
double ShareNearLine(const Camera& camera2, const PointConstraint& constraint, const Eigen::Vector2d& x2_px,
                     double sigma_px) {
  const Eigen::Vector2d d = constraint.line_direction.normalized();
  // The bounds of s for which x2 + s d is inside the image.
  double lower = -std::numeric_limits<double>::infinity(), upper = -lower;
  const Eigen::Vector2d first(-0.5, -0.5), last(camera2.width - 0.5, camera2.height - 0.5);
  for (int k = 0; k < 2; ++k) {
    if (d(k) == 0.0) continue;
    const double a = (first(k) - x2_px(k)) / d(k), b = (last(k) - x2_px(k)) / d(k);
    lower = std::max(lower, std::min(a, b));
    upper = std::min(upper, std::max(a, b));
  }
  const double half_width_px =
      1.96 * sigma_px * constraint.gradient_px.norm() / constraint.gradient_px.tail<2>().norm();
  return std::min(1.0, 2.0 * half_width_px * (upper - lower) / (1.0 * camera2.width * camera2.height));
}

// Square root of the trace of a covariance block, in degrees.
double RootMeanSquareDeg(const Eigen::MatrixXd& covariance) {
  return kDegPerRad * std::sqrt(covariance.trace());
}

void MeasureMotionInformation(const Scene& scene, const Points& points, double sigma_px, Severity* severity) {
  Matrix5d information = Matrix5d::Zero();
  Moments chance;
  for (const Eigen::Vector3d& point : points) {
    const PointConstraint constraint = ComputePointConstraint(scene, point);
    information += constraint.gradient_motion.transpose() * constraint.gradient_motion /
                   (sigma_px * sigma_px * constraint.gradient_px.squaredNorm());
    chance.Add(
        ShareNearLine(scene.camera2, constraint, scene.camera2.Project(scene.InCamera2(point)), sigma_px));
  }
  severity->chance_inlier_share = chance.mean();
  const Eigen::SelfAdjointEigenSolver<Matrix5d> eigen(information);
  const double least = eigen.eigenvalues()(0), greatest = eigen.eigenvalues()(4);
  // Below the rounding error of the sum the direction is undetermined.
  if (!(least > 1e-15 * greatest)) {
    severity->log10_condition = severity->crb_rotation_deg = severity->crb_direction_deg =
        std::numeric_limits<double>::infinity();
    return;
  }
  severity->log10_condition = std::log10(greatest / least);
  const Matrix5d bound = eigen.eigenvectors() * eigen.eigenvalues().cwiseInverse().asDiagonal() *
                         eigen.eigenvectors().transpose();
  severity->crb_rotation_deg = RootMeanSquareDeg(bound.topLeftCorner<3, 3>());
  severity->crb_direction_deg = RootMeanSquareDeg(bound.bottomRightCorner<2, 2>());
}

void MeasureRotationInformation(const Scene& scene, const Points& points, double sigma_px,
                                Severity* severity) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& point : points)
    information += ComputeRotationInformation(scene, point, sigma_px);
  const Eigen::Vector3d eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues();
  severity->log10_condition = std::log10(eigenvalues(2) / eigenvalues(0));
  severity->crb_rotation_deg = RootMeanSquareDeg(information.inverse());
  severity->crb_direction_deg = severity->chance_inlier_share = kNaN;
}

}  // namespace

Severity MeasureSeverity(const Scene& scene, const Observation& observation, double sigma_px,
                         RandomStream& rng) {
  Points points;  // of the true inliers
  size_t num_undetectable = 0;
  for (size_t i = 0; i < observation.matches.size(); ++i) {
    if (observation.is_inlier_true[i]) points.push_back(scene.points_in_cam1[observation.point[i]]);
    num_undetectable += observation.is_undetectable[i];
  }
  Severity severity;
  severity.undetectable_share =
      static_cast<double>(num_undetectable) / static_cast<double>(observation.matches.size());
  MeasureImages(scene, observation, &severity);
  MeasureParallax(scene, points, &severity);
  severity.planarity = Planarity(points);
  // The 95 % radius of the difference of two noisy points.
  severity.homography_share = HomographyShare(scene, points, std::sqrt(2.0) * 2.448 * sigma_px, rng);
  const auto measure = scene.IsDirectionDefined() ? MeasureMotionInformation : MeasureRotationInformation;
  measure(scene, points, sigma_px, &severity);
  return severity;
}

}  // namespace rcme
