#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// A detector on a pixel grid: normal noise, then every coordinate is rounded to the nearest multiple of the
// step (pixel centres for a step of 1). In this law alone sigma_px is not the root mean square of the noise,
// but that of its normal part. To a good approximation the total variance is sigma_px^2 + step^2 / 12, as the
// rounding error is uniform and independent of the point if scene and noise spread over many steps. The
// assumed noise level is therefore too small.
class QuantisedNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("sigma_px", &sigma_px_, {1e-9, 1000.0}, "px",
                            "rms noise per coordinate before rounding"),
            Parameter::Real("quantisation_step_px", &step_px_, {1e-6, 1000.0}, "px",
                            "detector's grid step; adds variance step^2 / 12 to that of sigma_px")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    for (Correspondence& match : matches) {
      for (double* x_px : Coordinates(match)) {
        *x_px = step_px_ * std::round((*x_px + sigma_px_ * rng.Normal()) / step_px_);
      }
    }
  }

 private:
  double step_px_ = 1.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeQuantisedNoise() { return std::make_unique<QuantisedNoise>(); }

}  // namespace rcme
