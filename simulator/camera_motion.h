#pragma once

#include <vector>

#include "estimator/geometry/pose.h"
#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// A general motion: rotation about a uniform axis by a uniform angle up to a bound, translation in a uniform
// direction.
struct GeneralMotion {
  double max_rotation_deg = 10.0;
  double baseline_m = 0.5;

  RelativePose Draw(RandomStream& rng) const;
};
std::vector<Parameter> Parameters(GeneralMotion& motion);

// Uniform on the unit sphere.
Eigen::Vector3d DrawDirection(RandomStream& rng);

}  // namespace rcme
