#include "experiments/real/sequences/trajectory.h"

#include <iterator>

namespace rcme {

TrueMotion12 MotionBetween(const CameraPose& pose1, const CameraPose& pose2) {
  const Eigen::Matrix3d R_cam2_from_world = pose2.R_world_from_cam.transpose();
  const Eigen::Vector3d t = R_cam2_from_world * (pose1.center - pose2.center);
  const double baseline = t.norm();
  return {{R_cam2_from_world * pose1.R_world_from_cam,
           baseline > 0.0 ? Eigen::Vector3d(t / baseline) : Eigen::Vector3d::UnitZ()},
          baseline};
}

bool Trajectory::Add(double time_s, const CameraPose& pose) {
  if (!poses_.empty() && !(time_s > poses_.rbegin()->first)) return false;
  poses_.emplace_hint(poses_.end(), time_s, pose);
  return true;
}

std::optional<CameraPose> Trajectory::At(double time_s, double max_gap_s) const {
  const auto after = poses_.lower_bound(time_s);
  if (after == poses_.end()) return std::nullopt;
  if (after->first == time_s) return after->second;
  if (after == poses_.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double gap_s = after->first - before->first;
  if (gap_s > max_gap_s) return std::nullopt;
  const double share = (time_s - before->first) / gap_s;
  const CameraPose &a = before->second, &b = after->second;
  const Eigen::Vector3d turn = VectorFromRotation(a.R_world_from_cam.transpose() * b.R_world_from_cam);
  return CameraPose{a.R_world_from_cam * RotationFromVector(share * turn),
                    a.center + share * (b.center - a.center)};
}

}  // namespace rcme
