#include "simulator/motion_sensors.h"

#include <cmath>

#include "stats/constants.h"

namespace rcme {
namespace {

constexpr double kLeastSdDeg = 1e-4, kGreatestSdDeg = 90.0;

Eigen::Vector3d DrawNormals(RandomStream& rng) {
  const double x = rng.Normal(), y = rng.Normal(), z = rng.Normal();
  return {x, y, z};
}

// A unit vector turned by the components of these rotation vectors perpendicular to it.
Eigen::Vector3d Turned(const Eigen::Vector3d& v, const Eigen::Vector3d& noise_rad,
                       const Eigen::Vector3d& bias_axis, double bias_rad) {
  const auto across = [&](const Eigen::Vector3d& w) { return Eigen::Vector3d(w - w.dot(v) * v); };
  const Eigen::Vector3d bias = bias_rad * across(bias_axis).normalized();
  return (RotationFromVector(across(noise_rad) + bias) * v).normalized();
}

}  // namespace

bool MotionSensors::IsNone() const {
  return std::isnan(rotation_sd_deg) && std::isnan(gravity_sd_deg) && std::isnan(direction_sd_deg);
}

MeasuredMotion MotionSensors::Measure(const ViewPair& view, RandomStream& rng) const {
  const RelativePose& truth = view.cam2_from_cam1_true;
  const double bias_rad = kRadPerDeg * bias_deg;
  const Eigen::Vector3d of_rotation = DrawNormals(rng), axis_of_rotation = DrawNormals(rng).normalized(),
                        of_gravity1 = DrawNormals(rng), of_gravity2 = DrawNormals(rng),
                        axis_of_gravity = DrawNormals(rng), of_direction = DrawNormals(rng),
                        axis_of_direction = DrawNormals(rng);
  MeasuredMotion measured;
  if (!std::isnan(rotation_sd_deg)) {
    const Eigen::Vector3d noise = kRadPerDeg * rotation_sd_deg * of_rotation;
    measured.R = RotationFromVector(bias_rad * axis_of_rotation) * RotationFromVector(noise) * truth.R;
  }
  if (!std::isnan(gravity_sd_deg)) {
    const double sd = kRadPerDeg * gravity_sd_deg;
    const Eigen::Vector3d down = Eigen::Vector3d::UnitY();
    measured.gravity = {Turned(down, sd * of_gravity1, axis_of_gravity, 0.0),
                        Turned(truth.R * down, sd * of_gravity2, axis_of_gravity, bias_rad)};
  }
  if (!std::isnan(direction_sd_deg) && view.IsDirectionDefined())
    measured.t = Turned(truth.t, kRadPerDeg * direction_sd_deg * of_direction, axis_of_direction, bias_rad);
  return measured;
}

std::vector<Parameter> Parameters(MotionSensors& sensors) {
  const Parameter::Range range{kLeastSdDeg, kGreatestSdDeg};
  return {Parameter::RealOrWord("prior_rotation_sd_deg", &sensors.rotation_sd_deg, range, "none", "deg",
                                "noise of the rotation prior about each axis"),
          Parameter::RealOrWord("prior_gravity_sd_deg", &sensors.gravity_sd_deg, range, "none", "deg",
                                "noise of the gravity prior in each camera"),
          Parameter::RealOrWord("prior_direction_sd_deg", &sensors.direction_sd_deg, range, "none", "deg",
                                "noise of the direction prior"),
          Parameter::Real("prior_bias_deg", &sensors.bias_deg, {0.0, 180.0}, "deg",
                          "rotation of the priors beyond their noise")};
}

}  // namespace rcme
