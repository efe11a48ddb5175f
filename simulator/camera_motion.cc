#include "simulator/camera_motion.h"

#include <cmath>
#include <numbers>

#include "stats/portable_math.h"

namespace rcme {

Eigen::Vector3d DrawDirection(RandomStream& rng) {
  // Archimedes: the height on the axis is uniform.
  const double z = rng.Uniform(-1.0, 1.0);
  const double radius = std::sqrt(1.0 - z * z);
  const CosSin azimuth = PortableCosSinOfTurn(rng.Uniform());
  return {radius * azimuth.cos, radius * azimuth.sin, z};
}

RelativePose GeneralMotion::Draw(RandomStream& rng) const {
  const Eigen::Vector3d axis = DrawDirection(rng);
  const double angle = rng.Uniform(0.0, max_rotation_deg * std::numbers::pi / 180.0);
  return {RotationFromVector(angle * axis), DrawDirection(rng)};
}

std::vector<Parameter> Parameters(GeneralMotion& motion) {
  return {Parameter::Real("max_rotation_deg", &motion.max_rotation_deg, {0.0, 180.0}, "deg",
                          "bound of the rotation angle, uniform from 0"),
          Parameter::Real("baseline_m", &motion.baseline_m, {1e-9, 1e6}, "m", "length of the translation")};
}

}  // namespace rcme
