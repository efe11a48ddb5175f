#include "simulator/noise/displacement_field.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"

namespace rcme {

DisplacementField::DisplacementField(double reach_px, RandomStream& rng) {
  for (Wave& wave : waves_) {
    const double divisor = 2.0 * std::numbers::pi * reach_px * std::max(std::abs(rng.Normal()), 1e-6);
    for (double* turns : {&wave.turns_per_px.x(), &wave.turns_per_px.y()}) *turns = rng.Normal() / divisor;
    for (Eigen::Vector2d* amplitude : {&wave.cosine, &wave.sine}) {
      amplitude->x() = rng.Normal();
      amplitude->y() = rng.Normal();
    }
  }
}

Eigen::Vector2d DisplacementField::At(const Eigen::Vector2d& x_px) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Wave& wave : waves_) {
    const double turns = wave.turns_per_px.x() * x_px.x() + wave.turns_per_px.y() * x_px.y();
    const CosSin at = PortableCosSinOfTurn(turns - std::floor(turns));
    sum += at.cos * wave.cosine + at.sin * wave.sine;
  }
  return sum / std::sqrt(static_cast<double>(kNumWaves));
}

namespace {

// Normal noise. A share of its variance is a field over each image, drawn in every trial: residual lens
// distortion, moving air, a rolling shutter under vibration. The rest is independent for each point.
class DisplacementFieldNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Real("displacement_share", &share_, {0.0, 1.0}, "",
                            "share of the variance from a field over the image"),
            Parameter::Real("displacement_reach_px", &reach_px_, {0.1, 1e5}, "px",
                            "reach of the field's correlation exp(-d / reach)")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const DisplacementField in_image1(reach_px_, rng), in_image2(reach_px_, rng);
    const double shared_px = sigma_px_ * std::sqrt(share_), own_px = sigma_px_ * std::sqrt(1.0 - share_);
    for (Correspondence& match : matches) {
      const Eigen::Vector2d by1 = shared_px * in_image1.At(match.x1_px),
                            by2 = shared_px * in_image2.At(match.x2_px);
      for (double* x_px : Coordinates(match)) *x_px += own_px * rng.Normal();
      match.x1_px += by1;
      match.x2_px += by2;
    }
  }

 private:
  double share_ = 0.2, reach_px_ = 100.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeDisplacementFieldNoise() {
  return std::make_unique<DisplacementFieldNoise>();
}

}  // namespace rcme
