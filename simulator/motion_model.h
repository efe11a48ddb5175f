#pragma once

#include <limits>
#include <vector>

#include "estimator/geometry/pose.h"
#include "parameters/parameter.h"
#include "stats/random.h"

namespace rcme {

// A motion with its length. Frames as in RelativePose: the centre of camera 2 is -baseline_m R' t in
// camera 1.
struct Motion {
  RelativePose cam2_from_cam1;  // |t| = 1
  double baseline_m = 0.0;
};

// A law of camera motions: the plug-in contract of simulator/motions. Configured once, then const and shared
// by threads.
class MotionModel {
 public:
  virtual ~MotionModel() = default;
  // The parameters by name; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  // `typical_depth_m` stands for the scene where the baseline is given as parallax.
  virtual Motion Draw(double typical_depth_m, RandomStream& rng) const = 0;
};

// The length of a translation, in metres or as the parallax of a sideways move at the scene's typical depth.
struct Baseline {
  double baseline_m = 0.5;
  double parallax_deg = std::numeric_limits<double>::quiet_NaN();  // NaN: in metres

  double Length(double typical_depth_m) const;
};
std::vector<Parameter> Parameters(Baseline& baseline);

// Uniform on the unit sphere.
Eigen::Vector3d DrawDirection(RandomStream& rng);

// Rotation about a uniform axis by an angle uniform from 0 to the bound (rad).
Eigen::Matrix3d DrawRotation(double max_angle_rad, RandomStream& rng);

}  // namespace rcme
