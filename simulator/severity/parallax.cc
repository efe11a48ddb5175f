#include "simulator/severity/parallax.h"

#include "stats/constants.h"

namespace rcme {

std::vector<double> ParallaxesDeg(const ViewPair& view, const std::vector<Eigen::Vector3d>& points_in_cam1) {
  std::vector<double> angles_deg;
  angles_deg.reserve(points_in_cam1.size());
  for (const Eigen::Vector3d& point : points_in_cam1) {
    angles_deg.push_back(kDegPerRad *
                         AngleBetween(view.cam2_from_cam1_true.R * point, view.InCamera2(point)));
  }
  return angles_deg;
}

}  // namespace rcme
