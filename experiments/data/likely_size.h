// The size of an image of which only the camera's intrinsics and some points are known.
#pragma once

#include <array>
#include <vector>

#include "estimator/motion_problem.h"

namespace rcme {

// Width and height, px: twice the principal point, or what holds all points if that is more. `x_px`: a point
// in this image.
std::array<int, 2> LikelySize(const Camera& camera, const std::vector<Correspondence>& matches,
                              Eigen::Vector2d Correspondence::*x_px);

inline constexpr double kMaxImageLength = 1e6;  // px

}  // namespace rcme
