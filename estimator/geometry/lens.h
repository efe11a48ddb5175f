// Real lenses: where a ray meets the image, and the point of an ideal pinhole camera that stands for a key
// point.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/camera.h"

namespace rcme {

// Of a ray (x, y, 1) with r^2 = x^2 + y^2, before K:
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

// A lens with these coefficients. Throws InputError that begins with `place`: a K that is singular,
// coefficients that are too few, too many or not finite.
Lens MakeLens(const Camera& camera, LensModel model, const std::vector<double>& coefficients,
              const std::string& place);

// Pixel of the ray (x, y, 1), and its derivative by (x, y), px.
Eigen::Vector2d ProjectThrough(const Lens& lens, const Eigen::Vector2d& ray);
Eigen::Matrix2d ProjectThroughJacobian(const Lens& lens, const Eigen::Vector2d& ray);

// Whether the lens shows this ray where it projects it: not beyond where distortion folds the image back, and
// less than ten focal lengths (84.3 deg) from the axis.
bool IsImaged(const Lens& lens, const Eigen::Vector2d& ray);

// Pixel of the same ray in a pinhole camera with the lens's K. Nothing where the lens sends no ray to this
// pixel, or more than one: beyond where distortion folds the image back.
std::optional<Eigen::Vector2d> Undistort(const Lens& lens, const Eigen::Vector2d& x_px);

// d undistorted pixel / d distorted pixel, at the undistorted one: by the inverse function theorem that of
// the projection, inverted. Noise of covariance C in the image as it was taken has J C J' in that of the
// pinhole.
Eigen::Matrix2d UndistortionJacobian(const Lens& lens, const Eigen::Vector2d& ideal_px);

}  // namespace rcme
