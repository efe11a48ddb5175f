#include <array>
#include <cmath>
#include <map>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// Normal noise of a detector that finds some points several times (one blob at two scales, with two
// orientations). With probability p a match repeats the scene point of an earlier match. The errors of
// matches of one point have correlation rho; all others are independent.
class DuplicatedNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Real("duplicated_share", &share_, {0.0, 0.95}, "",
                            "probability that a match repeats a matched point"),
            Parameter::Real("duplicated_correlation", &correlation_, {0.0, 1.0}, "",
                            "correlation of errors between matches of one point")};
  }

  void DrawPoints(std::span<std::uint32_t> points, RandomStream& rng) const override {
    for (std::uint32_t i = 1; i < points.size(); ++i) {
      if (rng.Uniform() < share_) points[i] = points[rng.IntegerBelow(i)];
    }
  }

  // Matches of one point are recognised by their equal exact places in both images.
  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    std::map<std::array<double, 4>, std::array<double, 4>> shared;  // normals, by place
    const double shared_px = sigma_px_ * std::sqrt(correlation_),
                 own_px = sigma_px_ * std::sqrt(1.0 - correlation_);
    for (Correspondence& match : matches) {
      const std::array<double*, 4> x_px = Coordinates(match);
      const auto [found, is_new] = shared.try_emplace({*x_px[0], *x_px[1], *x_px[2], *x_px[3]});
      for (size_t k = 0; k < 4; ++k) {
        if (is_new) found->second[k] = rng.Normal();
        *x_px[k] += shared_px * found->second[k] + own_px * rng.Normal();
      }
    }
  }

 private:
  double share_ = 0.3, correlation_ = 0.8;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeDuplicatedNoise() { return std::make_unique<DuplicatedNoise>(); }

}  // namespace rcme
