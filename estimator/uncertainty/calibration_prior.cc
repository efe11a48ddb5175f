#include "estimator/uncertainty/calibration_prior.h"

namespace rcme {
namespace {

// Changes one intrinsic of one image of the problem by a step.
using Change = std::function<void(Camera&, Eigen::Vector2d Correspondence::*, double, MotionProblem&)>;

void ScaleFocal(Camera& camera, Eigen::Vector2d Correspondence::*, double by, MotionProblem&) {
  camera.fx *= 1.0 + by;
  camera.fy *= 1.0 + by;
}

// Undistorts the points of one image by this k1, to first order.
void Undistort(Camera& camera, Eigen::Vector2d Correspondence::*x_px, double k1, MotionProblem& problem) {
  const Eigen::Vector2d centre_px(camera.cx, camera.cy);
  for (Correspondence& match : problem.matches) {
    const Eigen::Vector2d ray = camera.Ray(match.*x_px).head<2>();
    match.*x_px -= k1 * ray.squaredNorm() * (match.*x_px - centre_px);
  }
}

}  // namespace

Parameter FocalParameter(double* focal_sd) {
  return Parameter::Real(
      "focal_sd", focal_sd, {0.0, 0.5}, "",
      "relative standard deviation; widens the covariance (covariance=robust or rcme_calibrated); one above the "
      "usual raises rcme_calibrated's probability of failure");
}

Parameter PrincipalPointParameter(double* principal_point_sd_px) {
  return Parameter::Real("principal_point_sd_px", principal_point_sd_px, {0.0, 1e4}, "px",
                         "standard deviation per coordinate, likewise");
}

Parameter DistortionParameter(double* distortion_sd) {
  return Parameter::Real("distortion_sd", distortion_sd, {0.0, 0.5}, "",
                         "standard deviation of the remaining radial distortion k1, likewise");
}

Matrix5d CalibrationCovariance(const MotionProblem& problem, const CalibrationPrior& prior,
                               const Matrix5d& inverse_hessian,
                               const std::function<Vector5d(const MotionProblem&)>& gradient_of) {
  Matrix5d sum = Matrix5d::Zero();
  if (prior.IsNone()) return sum;
  const Vector5d base = gradient_of(problem);
  const auto add = [&](double sd, double step, const auto& change_images) {
    MotionProblem changed = problem;
    change_images(changed, step);
    const Vector5d moved = -(sd / step) * (inverse_hessian * (gradient_of(changed) - base));
    sum += moved * moved.transpose();
  };
  const bool is_one_camera = problem.camera1.K() == problem.camera2.K();
  const auto add_each = [&](double sd, double step, const Change& change) {
    if (!(sd > 0.0)) return;
    add(sd, step, [&](MotionProblem& p, double by) {
      change(p.camera1, &Correspondence::x1_px, by, p);
      if (is_one_camera) change(p.camera2, &Correspondence::x2_px, by, p);
    });
    if (is_one_camera) return;
    add(sd, step, [&](MotionProblem& p, double by) { change(p.camera2, &Correspondence::x2_px, by, p); });
  };
  const double step_px = 0.01 * problem.sigma_px;
  add_each(prior.focal_sd, step_px / problem.camera1.fx, ScaleFocal);
  for (const int axis : {0, 1}) {
    add_each(prior.principal_point_sd_px, step_px,
             [&](Camera& camera, Eigen::Vector2d Correspondence::*x_px, double by, MotionProblem&) {
               const bool is_image1 = x_px == &Correspondence::x1_px;
               const Eigen::Vector2d shift = by * (is_image1 ? prior.of_pixels1 : prior.of_pixels2).col(axis);
               camera.cx += shift.x();
               camera.cy += shift.y();
             });
  }
  add_each(prior.distortion_sd, step_px / problem.camera1.fx, Undistort);
  return sum;
}

}  // namespace rcme
