#include <numbers>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

// Density exp(-|e| / b) / (2 b), variance 2 b^2, independent in every coordinate.
class LaplaceNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override { return {SigmaParameter(&sigma_px_)}; }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const double b_px = sigma_px_ / std::numbers::sqrt2;
    for (Correspondence& match : matches) {
      for (double* x_px : Coordinates(match)) {
        const bool is_negative = rng.Uniform() < 0.5;
        const double size_px = -b_px * PortableLog(1.0 - rng.Uniform());  // 1 - U is in (0, 1]
        *x_px += is_negative ? -size_px : size_px;
      }
    }
  }
};

}  // namespace

std::unique_ptr<NoiseModel> MakeLaplaceNoise() { return std::make_unique<LaplaceNoise>(); }

}  // namespace rcme
