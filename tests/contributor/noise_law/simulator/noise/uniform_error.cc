#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// Uniform in [-b, b] in every coordinate, independent from coordinate to coordinate; its variance is b^2 / 3.
class UniformError : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override { return {SigmaParameter(&sigma_px_)}; }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const double b_px = std::sqrt(3.0) * sigma_px_;
    for (Correspondence& match : matches) {
      for (double* x_px : Coordinates(match)) *x_px += rng.Uniform(-b_px, b_px);
    }
  }
};

}  // namespace

std::unique_ptr<NoiseModel> MakeUniformError() { return std::make_unique<UniformError>(); }

}  // namespace rcme
