#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// A detector on the pixel grid: normal noise, then every coordinate is rounded to the nearest multiple of the
// step (pixel centres for a step of 1). This is the law whose sigma_px is not its root mean square: sigma_px
// is that of the normal part alone, as if the rounding had been forgotten. The total variance is sigma_px^2 +
// step^2 / 12 to a good approximation (the rounding error is uniform and does not depend on the point where
// scene and noise spread over many steps), so that the assumed noise level is too small.
class QuantisedNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        Parameter::Real("sigma_px", &sigma_px_, {1e-9, 1000.0}, "px",
                        "standard deviation of the noise per coordinate before it is rounded"),
        Parameter::Real("quantisation_step_px", &step_px_, {1e-6, 1000.0}, "px",
                        "distance of the detector's grid lines; adds a variance of step^2 / 12 that sigma_px "
                        "does not include")};
  }
  double sigma_px() const override { return sigma_px_; }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    for (Correspondence& match : matches) {
      for (double* x_px : Coordinates(match)) {
        *x_px = step_px_ * std::round((*x_px + sigma_px_ * rng.Normal()) / step_px_);
      }
    }
  }

 private:
  double sigma_px_ = 0.5;
  double step_px_ = 1.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeQuantisedNoise() { return std::make_unique<QuantisedNoise>(); }

}  // namespace rcme
