#pragma once

#include <Eigen/Core>
#include <vector>

#include "simulator/view_pair.h"

namespace rcme {

// The ground truth of one trial: two cameras, their motion, and points that both see.
struct Scene : ViewPair {
  std::vector<Eigen::Vector3d> points_in_cam1;  // metres
  // Shifts (m, camera 1's axes) that map a repeated structure onto itself; empty without repetition.
  std::vector<Eigen::Vector3d> repeat_steps_m;
};

}  // namespace rcme
