#pragma once

#include <cmath>
#include <limits>
#include <optional>
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

// The length of a translation, given in metres or by the parallax it causes.
struct Baseline {
  double baseline_m = 0.5;
  double parallax_deg = std::numeric_limits<double>::quiet_NaN();  // NaN: use baseline_m
  // The length that gives this parallax in a scene (SceneGenerator::FixBaseline); NaN: not computed yet.
  double length_of_parallax_m = std::numeric_limits<double>::quiet_NaN();

  bool IsParallax() const { return !std::isnan(parallax_deg); }
  // Throws std::logic_error if the length of a parallax is not computed yet.
  double Length() const;
};
std::vector<Parameter> Parameters(Baseline& baseline);

// A law of camera motions: the interface of the files in simulator/motions. Configured once, then const and
// shared by threads.
class MotionModel {
 public:
  virtual ~MotionModel() = default;
  // The parameters by name; valid as long as the model lives.
  virtual std::vector<Parameter> Parameters() = 0;
  // The length of the translation; null if the law has none.
  virtual Baseline* MutableBaseline() { return nullptr; }
  virtual Motion Draw(RandomStream& rng) const = 0;
  // A motion near a drawn one, by a reversible random step under which the law is stationary. `step` in (0,
  // 1] is the length of the step relative to the law's width. nullopt if the law has no such step.
  virtual std::optional<Motion> DrawNear(const Motion&, double /*step*/, RandomStream&) const {
    return std::nullopt;
  }
};

// Uniform on the unit sphere.
Eigen::Vector3d DrawDirection(RandomStream& rng);

// Rotation about a uniform axis by an angle uniform in [0, max_angle_rad].
Eigen::Matrix3d DrawRotation(double max_angle_rad, RandomStream& rng);

}  // namespace rcme
