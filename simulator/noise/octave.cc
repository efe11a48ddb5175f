#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// A detector on an image pyramid with the scale factor f. Level k has f^(-2k) times the area of level 0, and
// as many times its points; an error there is f^k times as large in pixels of level 0. A match has the same
// level in both images.
//
// Of the levels' variance f^(2k) each holds the same part, since P(k) f^(2k) does not depend on k:
//   E f^(2k) = L / sum_k f^(-2k),  L levels,
// so that a standard deviation of sigma_px f^k sqrt(sum f^(-2k) / L) has the root mean square sigma_px.
class OctaveNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Integer("num_octave_levels", &num_levels_, {1, 32}, "levels of the image pyramid"),
            Parameter::Real("octave_factor", &factor_, {1.0, 4.0}, "",
                            "scale of one level of the pyramid over that of the next finer one")};
  }
  double sigma_px() const override { return sigma_px_; }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    std::vector<double> area_up_to, scales;  // level by level
    double scale = 1.0, total_area = 0.0;
    for (int level = 0; level < num_levels_; ++level, scale *= factor_) {
      total_area += 1.0 / (scale * scale);
      area_up_to.push_back(total_area);
      scales.push_back(scale);
    }
    const double finest_px = sigma_px_ * std::sqrt(total_area / num_levels_);
    for (Correspondence& match : matches) {
      const double area = total_area * rng.Uniform();
      size_t level = 0;
      while (level + 1 < scales.size() && area >= area_up_to[level]) ++level;
      for (double* x_px : Coordinates(match)) *x_px += finest_px * scales[level] * rng.Normal();
    }
  }

 private:
  double sigma_px_ = 0.5;
  int num_levels_ = 8;  // with the factor: ORB's pyramid
  double factor_ = 1.2;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeOctaveNoise() { return std::make_unique<OctaveNoise>(); }

}  // namespace rcme
