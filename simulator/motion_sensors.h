// Sensors beside the cameras that measure the motion between the two images, with noise. Estimators that take
// priors receive the measurements and the standard deviations, nothing of the truth.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "parameters/parameter.h"
#include "simulator/view_pair.h"
#include "stats/random.h"

namespace rcme {

struct MeasuredMotion {
  std::optional<Eigen::Matrix3d> R;                       // from a gyroscope
  std::optional<std::array<Eigen::Vector3d, 2>> gravity;  // unit vectors, in camera 1 and in camera 2
  std::optional<Eigen::Vector3d> t;                       // direction of translation, unit length
};

// Standard deviations of the noise, deg; NaN: no such sensor. Camera 1, looking along z with y down, is
// upright: true gravity is (0, 1, 0) in its frame.
struct MotionSensors {
  double rotation_sd_deg = std::numeric_limits<double>::quiet_NaN();   // about each axis
  double gravity_sd_deg = std::numeric_limits<double>::quiet_NaN();    // per tangent axis, in each camera
  double direction_sd_deg = std::numeric_limits<double>::quiet_NaN();  // per tangent axis
  double bias_deg = 0.0;  // turn of each measurement, not included in its sd

  bool IsNone() const;
  // All random numbers are drawn whichever sensors there are, so that studies which differ only in sensors
  // are paired. Noise and bias turn the measurement: R by Exp(w) from the left, w ~ N(0, sd^2 I); a unit
  // vector by a rotation vector w perpendicular to it. The axis of the bias is uniform and drawn for each
  // measurement; for gravity only the vector in camera 2 is biased. Without translation there is no measured
  // direction.
  MeasuredMotion Measure(const ViewPair& view, RandomStream& rng) const;
};
std::vector<Parameter> Parameters(MotionSensors& sensors);

}  // namespace rcme
