// Camera poses and trajectories of data sets.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>

#include "estimator/geometry/pose.h"

namespace rcme {

// X_world = R X_cam + center.
struct CameraPose {
  Eigen::Matrix3d R_world_from_cam = Eigen::Matrix3d::Identity();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
};

// Returns cam2_from_cam1 and the length of the translation, in the unit of the data set. If it is zero, the
// direction is undetermined and set to (0, 0, 1).
struct TrueMotion12 {
  RelativePose cam2_from_cam1;
  double baseline = 0.0;
};
TrueMotion12 MotionBetween(const CameraPose& pose1, const CameraPose& pose2);

// Poses over time.
class Trajectory {
 public:
  // Adds a pose; returns false if it is not later than all before.
  bool Add(double time_s, const CameraPose& pose);

  // Interpolates between the two poses around the time, linearly in position and along the shortest
  // rotation. Nothing before the first pose, after the last, or in gaps longer than max_gap_s.
  std::optional<CameraPose> At(double time_s, double max_gap_s) const;

 private:
  std::map<double, CameraPose> poses_;
};

}  // namespace rcme
