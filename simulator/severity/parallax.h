#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/view_pair.h"

namespace rcme {

// The angle at each point between the rays to the two camera centres, deg.
std::vector<double> ParallaxesDeg(const ViewPair& view, const std::vector<Eigen::Vector3d>& points_in_cam1);

}  // namespace rcme
