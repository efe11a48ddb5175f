#include "estimator/geometry/triangulation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

namespace rcme {

double InverseDepth(const RelativePose& cam2_from_cam1, const Eigen::Vector3d& ray1,
                    const Eigen::Vector3d& ray2) {
  const Eigen::Vector3d at_infinity = ray2.cross(cam2_from_cam1.R * ray1);
  const Eigen::Vector3d parallax = ray2.cross(cam2_from_cam1.t);
  const double squared_parallax = parallax.squaredNorm();
  return squared_parallax > 0.0 ? -at_infinity.dot(parallax) / squared_parallax : 0.0;
}

bool IsInFrontOfBothCameras(const RelativePose& cam2_from_cam1, const Eigen::Vector3d& ray1,
                            const Eigen::Vector3d& ray2) {
  const double inverse_depth = InverseDepth(cam2_from_cam1, ray1, ray2);
  const Eigen::Vector3d in_cam2 = cam2_from_cam1.R * ray1 + inverse_depth * cam2_from_cam1.t;  // times depth1
  return inverse_depth > 0.0 && in_cam2.z() > 0.0;
}

RelativePose SelectPoseByCheirality(std::span<const RelativePose> poses,
                                    std::span<const Correspondence> matches, const Camera& camera1,
                                    const Camera& camera2) {
  const auto count_in_front = [&](const RelativePose& pose) {
    return std::count_if(matches.begin(), matches.end(), [&](const Correspondence& match) {
      return IsInFrontOfBothCameras(pose, camera1.Ray(match.x1_px), camera2.Ray(match.x2_px));
    });
  };
  std::vector<std::ptrdiff_t> counts;
  for (const RelativePose& pose : poses) counts.push_back(count_in_front(pose));
  return poses[static_cast<size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin())];
}

}  // namespace rcme
