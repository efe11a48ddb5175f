// Estimates the size of an image from the camera's intrinsics and some points.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// Returns width and height in px: twice the principal point, or more if that does not contain all points.
// `x_px` selects the point in this image.
std::array<int, 2> LikelySize(const Camera& camera, const std::vector<Correspondence>& matches,
                              Eigen::Vector2d Correspondence::*x_px);

inline constexpr double kMaxImageLength = 1e6;  // px

}  // namespace rcme
