#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// Tukey's contaminated normal, per match: a share p of the matches has c times the standard deviation of the
// others in all four coordinates. With s the others' standard deviation, (1 - p) s^2 + p c^2 s^2 =
// sigma_px^2.
class ContaminatedNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Real("contaminated_share", &share_, {0.0, 1.0}, "",
                            "probability that a match has the larger noise"),
            Parameter::Real("contaminated_scale", &scale_, {1.0, 1000.0}, "",
                            "larger over smaller standard deviation")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    const double good_px = sigma_px_ / std::sqrt(1.0 - share_ + share_ * scale_ * scale_);
    for (Correspondence& match : matches) {
      const double own_px = rng.Uniform() < share_ ? scale_ * good_px : good_px;
      for (double* x_px : Coordinates(match)) *x_px += own_px * rng.Normal();
    }
  }

 private:
  double share_ = 0.1, scale_ = 5.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeContaminatedNoise() { return std::make_unique<ContaminatedNoise>(); }

}  // namespace rcme
