#include "estimator/geometry/lens.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "parameters/input_error.h"

namespace rcme {
namespace {

Eigen::Vector2d DistortRadtan(const std::array<double, 8>& k, const Eigen::Vector2d& ray) {
  const double x = ray.x(), y = ray.y(), r2 = ray.squaredNorm();
  const double radial =
      (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return radial * ray + Eigen::Vector2d(2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x),
                                        k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y);
}

Eigen::Vector2d DistortFisheye(const std::array<double, 8>& k, const Eigen::Vector2d& ray) {
  const double r = ray.norm();
  if (r < 1e-12) return ray;
  const double theta = std::atan(r), t2 = theta * theta;
  return theta * (1.0 + t2 * (k[0] + t2 * (k[1] + t2 * (k[2] + t2 * k[3])))) / r * ray;
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

// 2x2, by central differences.
Eigen::Matrix2d DistortJacobian(const Lens& lens, const Eigen::Vector2d& ray) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix2d J;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
    J.col(i) = (Distort(lens, ray + step) - Distort(lens, ray - step)) / (2.0 * kStep);
  }
  return J;
}

// From the centre outwards the distorted radius grows as far as `ray`: the first ray that a pixel has.
bool IsOnFirstBranch(const Lens& lens, const Eigen::Vector2d& ray) {
  constexpr int kSteps = 20;
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

std::optional<Eigen::Vector2d> Undistort(const Lens& lens, const Eigen::Vector2d& x_px) {
  if (lens.model == LensModel::kPinhole) return x_px;
  constexpr int kMaxSteps = 50;
  constexpr double kDonePx = 1e-7, kLargestRay = 10.0;
  const Eigen::Vector2d wanted = lens.camera.Ray(x_px).head<2>();
  Eigen::Vector2d ray = Eigen::Vector2d::Zero();
  // Newton's steps from the centre, each of at most half a focal length.
  for (int step = 0; step < kMaxSteps; ++step) {
    const Eigen::Vector2d misfit = wanted - Distort(lens, ray);
    if (misfit.norm() * lens.camera.fx < kDonePx) {
      if (!IsOnFirstBranch(lens, ray)) return std::nullopt;
      return lens.camera.Project({ray.x(), ray.y(), 1.0});
    }
    Eigen::Vector2d change = DistortJacobian(lens, ray).inverse() * misfit;
    const double longest = 0.5;
    if (change.norm() > longest) change *= longest / change.norm();
    ray += change;
    if (!(ray.norm() < kLargestRay)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace rcme
