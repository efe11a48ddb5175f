#include <cmath>

#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// Normal with the same covariance (2x2, px^2) in both images: standard deviations a >= b along two
// perpendicular axes. The noise along an axis is correlated between image 1 and image 2. The root mean square
// over the coordinates equals that over the axes: a^2 + b^2 = 2 sigma_px^2.
class AnisotropicNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Real("noise_axis_ratio", &axis_ratio_, {1.0, 1000.0}, "",
                            "standard deviation along the major over the minor axis"),
            Parameter::Real("noise_axis_deg", &axis_deg_, {0.0, 180.0}, "deg",
                            "major axis, from x towards y (down); 0, 90 and 180: x and y uncorrelated"),
            Parameter::Real("image_correlation", &image_correlation_, {-1.0, 1.0}, "",
                            "correlation between the images along each axis")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const double minor_px = sigma_px_ * std::sqrt(2.0 / (1.0 + axis_ratio_ * axis_ratio_));
    const CosSin axis = PortableCosSinOfTurn(axis_deg_ / 360.0);
    const Eigen::Vector2d major(axis_ratio_ * minor_px * axis.cos, axis_ratio_ * minor_px * axis.sin);
    const Eigen::Vector2d minor(-minor_px * axis.sin, minor_px * axis.cos);
    const double shared = image_correlation_, own = std::sqrt(1.0 - shared * shared);
    for (Correspondence& match : matches) {
      const double z1_major = rng.Normal(), z1_minor = rng.Normal();
      const double z2_major = shared * z1_major + own * rng.Normal();
      const double z2_minor = shared * z1_minor + own * rng.Normal();
      match.x1_px += z1_major * major + z1_minor * minor;
      match.x2_px += z2_major * major + z2_minor * minor;
    }
  }

 private:
  double axis_ratio_ = 3.0, axis_deg_ = 45.0, image_correlation_ = 0.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeAnisotropicNoise() { return std::make_unique<AnisotropicNoise>(); }

}  // namespace rcme
