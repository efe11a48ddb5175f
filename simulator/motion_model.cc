#include "simulator/motion_model.h"

#include <cmath>
#include <numbers>

#include "stats/portable_math.h"

namespace rcme {

double Baseline::Length(double typical_depth_m) const {
  if (std::isnan(parallax_deg)) return baseline_m;
  // The rays of the two ends of the baseline to a point half-way between them, at that depth.
  return 2.0 * typical_depth_m * std::tan(0.5 * parallax_deg * std::numbers::pi / 180.0);
}

std::vector<Parameter> Parameters(Baseline& baseline) {
  return {
      Parameter::Real("baseline_m", &baseline.baseline_m, {1e-9, 1e6}, "m", "length of the translation"),
      Parameter::RealOrWord("parallax_deg", &baseline.parallax_deg, {1e-9, 120.0}, "none", "deg",
                            "the length as an angle instead: the parallax of a point at the scene's typical "
                            "depth under a sideways move of that length")};
}

Eigen::Vector3d DrawDirection(RandomStream& rng) {
  // Archimedes: the height on the axis is uniform.
  const double z = rng.Uniform(-1.0, 1.0);
  const double radius = std::sqrt(1.0 - z * z);
  const CosSin azimuth = PortableCosSinOfTurn(rng.Uniform());
  return {radius * azimuth.cos, radius * azimuth.sin, z};
}

Eigen::Matrix3d DrawRotation(double max_angle_rad, RandomStream& rng) {
  const Eigen::Vector3d axis = DrawDirection(rng);
  return RotationFromVector(rng.Uniform(0.0, max_angle_rad) * axis);
}

}  // namespace rcme
