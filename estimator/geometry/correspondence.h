#pragma once

#include <Eigen/Core>

namespace rcme {

// One putative match: the same scene point seen in both images (or a wrong match), in pixels. The paper's
// 4-vector X = [x1; x2]. Pixel (0, 0) is the centre of the top-left pixel, x to the right, y down.
struct Correspondence {
  Eigen::Vector2d x1_px = Eigen::Vector2d::Zero();
  Eigen::Vector2d x2_px = Eigen::Vector2d::Zero();
};

}  // namespace rcme
