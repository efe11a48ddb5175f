// Lens models: the pixel of a ray, and the pixel that an ideal pinhole camera would have in its place.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"

namespace rcme {

// The distorted point of a ray (x, y, 1) with r^2 = x^2 + y^2, before K:
//
//   kRadtan    k1 k2 p1 p2 [k3 [k4 k5 k6]], the polynomial model with tangential terms (Brown 1966):
//              (x, y) (1 + k1 r^2 + k2 r^4 + k3 r^6) / (1 + k4 r^2 + k5 r^4 + k6 r^6)
//              + (2 p1 x y + p2 (r^2 + 2 x^2), p1 (r^2 + 2 y^2) + 2 p2 x y)
//   kFisheye   k1 k2 k3 k4, equidistant (Kannala & Brandt 2006): with theta = atan r,
//              (x, y) theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8) / r
enum class LensModel { kPinhole, kRadtan, kFisheye };
const std::vector<std::pair<std::string, LensModel>>& LensModelNames();

struct Lens {
  Camera camera;
  LensModel model = LensModel::kPinhole;
  std::array<double, 8> k{};  // in the order above
};

// A lens with these coefficients. Throws InputError that begins with `place` if the camera is not valid (an
// image of width 0 is allowed), or coefficients are too few, too many or not finite.
Lens MakeLens(const Camera& camera, LensModel model, const std::vector<double>& coefficients,
              const std::string& place);

// Pixel of the ray (x, y, 1), and its derivative with respect to (x, y), px.
Eigen::Vector2d ProjectThrough(const Lens& lens, const Eigen::Vector2d& ray);
Eigen::Matrix2d ProjectThroughJacobian(const Lens& lens, const Eigen::Vector2d& ray);

// A ray is at most so many focal lengths from the axis: 84.3 deg.
inline constexpr double kLargestRay = 10.0;

// Whether the lens images this ray at its projection: the ray is less than kLargestRay from the axis, and not
// beyond the fold of the distortion, where the image radius stops growing.
bool IsImaged(const Lens& lens, const Eigen::Vector2d& ray);

// Pixel of the same ray in a pinhole camera with the lens's K. nullopt if no ray that IsImaged reaches this
// pixel.
std::optional<Eigen::Vector2d> Undistort(const Lens& lens, const Eigen::Vector2d& x_px);

// d undistorted pixel / d distorted pixel at the undistorted pixel, the inverse of the projection's
// derivative. Noise of covariance C in the distorted image has covariance J C J' in the pinhole image.
Eigen::Matrix2d UndistortionJacobian(const Lens& lens, const Eigen::Vector2d& ideal_px);

}  // namespace rcme
