// Sensors beside the cameras: what they measure of the motion between the two images, with noise. Estimators
// that take priors get the measurements and the standard deviations; of the truth they get nothing.
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
  std::optional<Eigen::Matrix3d> R;                       // a gyroscope's
  std::optional<std::array<Eigen::Vector3d, 2>> gravity;  // unit vectors, in camera 1 and in camera 2
  std::optional<Eigen::Vector3d> t;                       // a direction of travel, of unit length
};

// Standard deviations of the noise, deg; NaN: no such sensor. The camera that looks along z with y down
// stands upright in the first image: true gravity is (0, 1, 0) there.
struct MotionSensors {
  double rotation_sd_deg = std::numeric_limits<double>::quiet_NaN();   // about each axis
  double gravity_sd_deg = std::numeric_limits<double>::quiet_NaN();    // per axis across, of each camera's
  double direction_sd_deg = std::numeric_limits<double>::quiet_NaN();  // per axis across
  double bias_deg = 0.0;  // a turn of every measurement that its standard deviation does not know of

  bool IsNone() const;
  // Every number is drawn whichever sensors there are, so that studies which differ in them are paired. Noise
  // and bias turn the measurement: R by Exp(w) on its left, w ~ N(0, sd^2 I); a unit vector by a w across it.
  // The axis of the bias is uniform, for each measurement anew; of gravity only the second is biased. Without
  // a translation there is no direction to be measured.
  MeasuredMotion Measure(const ViewPair& view, RandomStream& rng) const;
};
std::vector<Parameter> Parameters(MotionSensors& sensors);

}  // namespace rcme
