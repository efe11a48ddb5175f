#include "estimator/uncertainty/calibration_prior.h"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace rcme {
namespace {

// Undistorts the points of one image by this k1, to first order.
void Undistort(const Camera& camera, Eigen::Vector2d Correspondence::*x_px, double k1,
               MotionProblem& problem) {
  const Eigen::Vector2d centre_px(camera.cx, camera.cy);
  for (Correspondence& match : problem.matches) {
    const Eigen::Vector2d ray = camera.Ray(match.*x_px).head<2>();
    match.*x_px -= k1 * ray.squaredNorm() * (match.*x_px - centre_px);
  }
}

enum class Intrinsic { kFocal, kCx, kCy, kDistortion };

// One image of a problem.
struct Image {
  Camera MotionProblem::*camera;
  Eigen::Vector2d Correspondence::*x_px;
  Lens Undistortion::*lens;
  const Eigen::Matrix2d& of_pixels;  // of CalibrationPrior
};

// Changes an intrinsic of an image without distortion by a step.
void ChangeCamera(const Image& image, Intrinsic intrinsic, double by, MotionProblem& problem) {
  Camera& camera = problem.*image.camera;
  if (intrinsic == Intrinsic::kFocal) {
    camera.fx *= 1.0 + by;
    camera.fy *= 1.0 + by;
  } else if (intrinsic == Intrinsic::kDistortion) {
    Undistort(camera, image.x_px, by, problem);
  } else {
    const Eigen::Vector2d shift = by * image.of_pixels.col(intrinsic == Intrinsic::kCx ? 0 : 1);
    camera.cx += shift.x();
    camera.cy += shift.y();
  }
}

Lens ChangeLens(Lens lens, Intrinsic intrinsic, double by) {
  switch (intrinsic) {
    case Intrinsic::kFocal:
      lens.camera.fx *= 1.0 + by;
      lens.camera.fy *= 1.0 + by;
      break;
    case Intrinsic::kCx:
      lens.camera.cx += by;
      break;
    case Intrinsic::kCy:
      lens.camera.cy += by;
      break;
    case Intrinsic::kDistortion:
      if (lens.model == LensModel::kPinhole) lens.model = LensModel::kRadtan;
      lens.k[0] += by;
  }
  return lens;
}

// Moves the points of an image that a lens distorts to where they would be if they had been undistorted by
// another lens: by one step of Newton's method, which is exact to first order. `turn` maps rays of the lens
// to those of the problem; it is a rotation about the optical axis.
void ExchangeLens(const Image& image, const Lens& other, MotionProblem& problem) {
  const Lens& lens = (*problem.undistortion).*image.lens;
  const Camera& camera = problem.*image.camera;
  const Eigen::Matrix2d turn = Eigen::Vector2d(1.0 / camera.fx, 1.0 / camera.fy).asDiagonal() *
                               image.of_pixels * Eigen::Vector2d(lens.camera.fx, lens.camera.fy).asDiagonal();
  for (Correspondence& match : problem.matches) {
    const Eigen::Vector2d ray = turn.transpose() * camera.Ray(match.*image.x_px).head<2>();
    const Eigen::Vector2d misfit_px = ProjectThrough(lens, ray) - ProjectThrough(other, ray);
    const Eigen::Vector2d moved = ray + ProjectThroughJacobian(other, ray).inverse() * misfit_px;
    match.*image.x_px = camera.Project((turn * moved).homogeneous());
  }
}

void Change(const Image& image, Intrinsic intrinsic, double by, MotionProblem& problem) {
  if (!problem.undistortion) return ChangeCamera(image, intrinsic, by, problem);
  ExchangeLens(image, ChangeLens((*problem.undistortion).*image.lens, intrinsic, by), problem);
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

bool IsOfOneCamera(const MotionProblem& problem) {
  if (!problem.camera1.K().isApprox(problem.camera2.K(), 1e-4)) return false;
  if (!problem.undistortion) return true;
  const auto& [lens1, lens2, _] = *problem.undistortion;
  return lens1.model == lens2.model && lens1.k == lens2.k;
}

Matrix5d CalibrationCovariance(const MotionProblem& problem, const CalibrationPrior& prior,
                               const Matrix5d& inverse_hessian,
                               const std::function<Vector5d(const MotionProblem&)>& gradient_of) {
  Matrix5d sum = Matrix5d::Zero();
  if (prior.IsNone()) return sum;
  const Vector5d base = gradient_of(problem);
  const auto add = [&](double sd, double step, const auto& change_images) {
    MotionProblem changed = problem;
    change_images(changed);
    const Vector5d moved = -(sd / step) * (inverse_hessian * (gradient_of(changed) - base));
    sum += moved * moved.transpose();
  };
  const Image image1{&MotionProblem::camera1, &Correspondence::x1_px, &Undistortion::lens1, prior.of_pixels1},
      image2{&MotionProblem::camera2, &Correspondence::x2_px, &Undistortion::lens2, prior.of_pixels2};
  const bool is_one_camera = IsOfOneCamera(problem);
  const double step_px = 0.01 * problem.sigma_px, step = step_px / problem.camera1.fx;
  struct Uncertain {
    Intrinsic intrinsic;
    double sd, step;
  };
  for (const Uncertain& one : {Uncertain{Intrinsic::kFocal, prior.focal_sd, step},
                               Uncertain{Intrinsic::kCx, prior.principal_point_sd_px, step_px},
                               Uncertain{Intrinsic::kCy, prior.principal_point_sd_px, step_px},
                               Uncertain{Intrinsic::kDistortion, prior.distortion_sd, step}}) {
    if (!(one.sd > 0.0)) continue;
    add(one.sd, one.step, [&](MotionProblem& changed) {
      Change(image1, one.intrinsic, one.step, changed);
      if (is_one_camera) Change(image2, one.intrinsic, one.step, changed);
    });
    if (is_one_camera) continue;
    add(one.sd, one.step, [&](MotionProblem& changed) { Change(image2, one.intrinsic, one.step, changed); });
  }
  return sum;
}

}  // namespace rcme
