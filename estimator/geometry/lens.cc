#include "estimator/geometry/lens.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "parameters/input_error.h"

namespace rcme {
namespace {

using Coefficients = std::array<double, 8>;

// The radial factor (1 + k1 s + k2 s^2 + k3 s^3) / (1 + k4 s + k5 s^2 + k6 s^3), s = r^2, and its derivative
// with respect to s.
struct RadialFactor {
  double value, slope;
};
RadialFactor ComputeRadialFactor(const Coefficients& k, double r2) {
  const double above = 1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]));
  const double below = 1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7]));
  const double above_slope = k[0] + r2 * (2.0 * k[1] + 3.0 * r2 * k[4]);
  const double below_slope = k[5] + r2 * (2.0 * k[6] + 3.0 * r2 * k[7]);
  return {above / below, (above_slope * below - above * below_slope) / (below * below)};
}

Eigen::Vector2d DistortRadtan(const Coefficients& k, const Eigen::Vector2d& ray) {
  const double x = ray.x(), y = ray.y(), r2 = ray.squaredNorm();
  return ComputeRadialFactor(k, r2).value * ray +
         Eigen::Vector2d(2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
                         k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y);
}

// With x = (x, y), s = x'x and the factor g(s): d (g x) / d x = g I + 2 g' x x'. The tangential terms are the
// gradient of (p2 x + p1 y) (x^2 + y^2), so their derivative is symmetric.
Eigen::Matrix2d RadtanJacobian(const Coefficients& k, const Eigen::Vector2d& ray) {
  const double x = ray.x(), y = ray.y();
  const RadialFactor radial = ComputeRadialFactor(k, ray.squaredNorm());
  const double mixed = 2.0 * (k[2] * x + k[3] * y);
  Eigen::Matrix2d tangential;
  tangential << 2.0 * k[2] * y + 6.0 * k[3] * x, mixed, mixed, 6.0 * k[2] * y + 2.0 * k[3] * x;
  return radial.value * Eigen::Matrix2d::Identity() + 2.0 * radial.slope * ray * ray.transpose() + tangential;
}

// theta (1 + k1 theta^2 + ...), the distance from the axis in focal lengths, and its derivative with respect
// to theta.
struct FisheyeRadius {
  double value, slope;
};
FisheyeRadius ComputeFisheyeRadius(const Coefficients& k, double theta) {
  const double t2 = theta * theta;
  return {theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))),
          1.0 + t2 * (3.0 * k[0] + t2 * (5.0 * k[1] + t2 * (7.0 * k[2] + t2 * 9.0 * k[3])))};
}
constexpr double kOnAxis = 1e-12;  // closer to the axis the lens counts as a pinhole

Eigen::Vector2d DistortFisheye(const Coefficients& k, const Eigen::Vector2d& ray) {
  const double r = ray.norm();
  if (r < kOnAxis) return ray;
  return ComputeFisheyeRadius(k, std::atan(r)).value / r * ray;
}

// Along the unit vector n of the ray the radius grows by d radius / d theta * d theta / d r, d theta / d r =
// 1 / (1 + r^2). Across n the scale is radius / r.
Eigen::Matrix2d FisheyeJacobian(const Coefficients& k, const Eigen::Vector2d& ray) {
  const double r = ray.norm();
  if (r < kOnAxis) return Eigen::Matrix2d::Identity();
  const FisheyeRadius radius = ComputeFisheyeRadius(k, std::atan(r));
  const Eigen::Vector2d n = ray / r;
  const double along = radius.slope / (1.0 + r * r), across = radius.value / r;
  return across * Eigen::Matrix2d::Identity() + (along - across) * n * n.transpose();
}

Eigen::Vector2d Distort(const Lens& lens, const Eigen::Vector2d& ray) {
  switch (lens.model) {
    case LensModel::kPinhole:
      return ray;
    case LensModel::kRadtan:
      return DistortRadtan(lens.k, ray);
    case LensModel::kFisheye:
      break;
  }
  return DistortFisheye(lens.k, ray);
}

// d distorted / d ray.
Eigen::Matrix2d DistortJacobian(const Lens& lens, const Eigen::Vector2d& ray) {
  switch (lens.model) {
    case LensModel::kPinhole:
      return Eigen::Matrix2d::Identity();
    case LensModel::kRadtan:
      return RadtanJacobian(lens.k, ray);
    case LensModel::kFisheye:
      break;
  }
  return FisheyeJacobian(lens.k, ray);
}

// Whether the distorted radius grows all the way from the centre to `ray`. If so, this is the first ray that
// reaches its pixel.
bool IsOnFirstBranch(const Lens& lens, const Eigen::Vector2d& ray) {
  constexpr int kSteps = 20;
  if (lens.model == LensModel::kFisheye) {
    const double theta = std::atan(ray.norm());
    for (int i = 0; i <= kSteps; ++i) {
      if (!(ComputeFisheyeRadius(lens.k, theta * i / kSteps).slope > 0.0)) return false;
    }
    return true;
  }
  for (int i = 0; i <= kSteps; ++i) {
    if (!(DistortJacobian(lens, ray * (1.0 * i / kSteps)).determinant() > 0.0)) return false;
  }
  return true;
}

}  // namespace

const std::vector<std::pair<std::string, LensModel>>& LensModelNames() {
  static const std::vector<std::pair<std::string, LensModel>> names = {
      {"pinhole", LensModel::kPinhole}, {"radtan", LensModel::kRadtan}, {"fisheye", LensModel::kFisheye}};
  return names;
}

Lens MakeLens(const Camera& camera, LensModel model, const std::vector<double>& coefficients,
              const std::string& place) {
  Camera sized = camera;  // the size may come later, from the first image
  if (camera.width == 0) sized.width = sized.height = 1;
  if (!sized.IsValid())
    throw InputError(
        fmt::format("{}: fx {}, fy {}, cx {}, cy {} are not a camera; all must be finite, fx and fy > 0",
                    place, camera.fx, camera.fy, camera.cx, camera.cy));
  const size_t n = coefficients.size();
  const bool fits = model == LensModel::kPinhole  ? n == 0
                    : model == LensModel::kRadtan ? n == 4 || n == 5 || n == 8
                                                  : n == 4;
  if (!fits) {
    throw InputError(
        fmt::format("{}: {} distortion coefficients; radtan has 4, 5 or 8 (k1 k2 p1 p2 [k3 [k4 k5 k6]]), "
                    "fisheye 4 (k1 k2 k3 k4), pinhole none",
                    place, n));
  }
  if (!std::ranges::all_of(coefficients, [](double x) { return std::isfinite(x); }))
    throw InputError(fmt::format("{}: a distortion coefficient is not finite", place));
  Lens lens{camera, model, {}};
  std::ranges::copy(coefficients, lens.k.begin());
  return lens;
}

Eigen::Vector2d ProjectThrough(const Lens& lens, const Eigen::Vector2d& ray) {
  const Eigen::Vector2d distorted = Distort(lens, ray);
  return lens.camera.Project({distorted.x(), distorted.y(), 1.0});
}

Eigen::Matrix2d ProjectThroughJacobian(const Lens& lens, const Eigen::Vector2d& ray) {
  return Eigen::Vector2d(lens.camera.fx, lens.camera.fy).asDiagonal() * DistortJacobian(lens, ray);
}

bool IsImaged(const Lens& lens, const Eigen::Vector2d& ray) {
  return lens.model == LensModel::kPinhole || (ray.norm() < kLargestRay && IsOnFirstBranch(lens, ray));
}

std::optional<Eigen::Vector2d> Undistort(const Lens& lens, const Eigen::Vector2d& x_px) {
  if (lens.model == LensModel::kPinhole) return x_px;
  constexpr int kMaxSteps = 50;
  constexpr double kDonePx = 1e-7, kLongestStep = 0.5, kRounding = 1e-14;
  const Eigen::Vector2d wanted = lens.camera.Ray(x_px).head<2>();
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  // Newton's method from the centre with steps of at most half a focal length. The step after a sufficiently
  // small misfit is still taken, which squares it once more: only rounding remains.
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d misfit = wanted - Distort(lens, ray);
    Eigen::Vector2d change = DistortJacobian(lens, ray).inverse() * misfit;
    if (change.norm() > kLongestStep) change *= kLongestStep / change.norm();
    ray += change;
    if (!(ray.norm() < kLargestRay)) return std::nullopt;
    if (misfit.norm() >= std::max(kDonePx / lens.camera.fx, kRounding * (1.0 + wanted.norm()))) continue;
    if (!IsOnFirstBranch(lens, ray)) return std::nullopt;
    return lens.camera.Project({ray.x(), ray.y(), 1.0});
  }
  return std::nullopt;
}

Eigen::Matrix2d UndistortionJacobian(const Lens& lens, const Eigen::Vector2d& ideal_px) {
  if (lens.model == LensModel::kPinhole) return Eigen::Matrix2d::Identity();
  return Eigen::Vector2d(lens.camera.fx, lens.camera.fy).asDiagonal() *
         ProjectThroughJacobian(lens, lens.camera.Ray(ideal_px).head<2>()).inverse();
}

}  // namespace rcme
