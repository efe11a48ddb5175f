#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/view_pair.h"

namespace rcme {

// The parallax of each point, deg: the angle at the point between the rays to the two camera centres.
std::vector<double> ParallaxesDeg(const ViewPair& view, const std::vector<Eigen::Vector3d>& points_in_cam1);

}  // namespace rcme
