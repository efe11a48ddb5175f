#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/view_pair.h"

namespace rcme {

// The angle at each point between the rays to the two camera centres, deg.
std::vector<double> ParallaxesDeg(const ViewPair& view, const std::vector<Eigen::Vector3d>& points_in_cam1);

// The value at rank floor(probability (n - 1)), from 0, of n in rising order; the values are reordered. NaN
// if there are no values.
double QuantileOf(std::vector<double>& values, double probability);

}  // namespace rcme
