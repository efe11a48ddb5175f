// Where a camera was, as data sets say it.
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

// cam2_from_cam1 and how far the camera went, in the data set's unit. The direction is undetermined, (0, 0,
// 1), where that is zero.
struct TrueMotion12 {
  RelativePose cam2_from_cam1;
  double baseline = 0.0;
};
TrueMotion12 MotionBetween(const CameraPose& pose1, const CameraPose& pose2);

// Poses over time.
class Trajectory {
 public:
  // Later than all before; false: it is not.
  bool Add(double time_s, const CameraPose& pose);
  bool empty() const { return poses_.empty(); }

  // Between the two poses about the time, linear in position and along the shortest rotation. Nothing before
  // the first, after the last and in gaps longer than max_gap_s.
  std::optional<CameraPose> At(double time_s, double max_gap_s) const;

 private:
  std::map<double, CameraPose> poses_;
};

}  // namespace rcme
