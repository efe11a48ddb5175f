#include "simulator/motion_model.h"

#include <cmath>
#include <stdexcept>

#include "stats/portable_math.h"

namespace rcme {

double Baseline::Length() const {
  if (!IsParallax()) return baseline_m;
  if (std::isnan(length_of_parallax_m)) throw std::logic_error("the baseline of a parallax is not fixed yet");
  return length_of_parallax_m;
}

std::vector<Parameter> Parameters(Baseline& baseline) {
  return {Parameter::Real("baseline_m", &baseline.baseline_m, {1e-9, 1e6}, "m", "length of the translation"),
          Parameter::RealOrWord("parallax_deg", &baseline.parallax_deg, {1e-9, 120.0}, "none", "deg",
                                "length as a parallax angle instead: median over points, mean over trials")};
}

Eigen::Vector3d DrawDirection(RandomStream& rng) {
  // On the sphere the height along an axis is uniform (Archimedes).
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
