#include <cmath>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

// A detector on an image pyramid with scale factor f. Level k has f^(-2k) times the area of level 0 and as
// many times its points. Its error in pixels of level 0 grows as f^(g k), g = octave_growth. With g = 1 a key
// point is located within a fixed fraction of a pixel of its level, with g = 0 the error is the same on all
// levels. A match has the same level in both images.
//
// With g = 1 every level contributes the same part to the variance, since P(k) f^(2k) does not depend on k:
//   E f^(2k) = L / sum_k f^(-2k),  L levels,
// so a standard deviation of sigma_px f^k sqrt(sum f^(-2k) / L) has the root mean square sigma_px.
//
// The detector states that the error grows as f^(h k), h = stated_growth; with h = 0 it states nothing.
class OctaveNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {SigmaParameter(&sigma_px_),
            Parameter::Integer("num_octave_levels", &num_levels_, {1, 32}, "levels of the image pyramid"),
            Parameter::Real("octave_factor", &factor_, {1.0, 4.0}, "",
                            "scale of a level over the next finer one"),
            Parameter::Real("octave_growth", &growth_, {0.0, 4.0}, "",
                            "power of the level's scale by which noise grows"),
            Parameter::Real("stated_growth", &stated_growth_, {0.0, 4.0}, "",
                            "power that estimators are told, per match relative to the median; 0: nothing")};
  }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    AddAndTell(matches, rng);
  }

  std::vector<double> AddAndTell(std::span<Correspondence> matches, RandomStream& rng) const override {
    const Pyramid pyramid = MakePyramid();
    std::vector<double> stated;
    for (Correspondence& match : matches) {
      const double area = pyramid.total_area * rng.Uniform();
      size_t level = 0;
      while (level + 1 < pyramid.sds.size() && area >= pyramid.area_up_to[level]) ++level;
      for (double* x_px : Coordinates(match)) *x_px += pyramid.sds[level] * rng.Normal();
      if (stated_growth_ > 0.0) stated.push_back(pyramid.stated[level]);
    }
    return stated;
  }

 private:
  // One entry per level.
  struct Pyramid {
    std::vector<double> area_up_to, sds;  // px
    std::vector<double> stated;           // over sigma_px; correct if stated_growth = octave_growth
    double total_area = 0.0;
  };
  Pyramid MakePyramid() const {
    Pyramid pyramid;
    double scale = 1.0, variance = 0.0, stated_variance = 0.0;
    for (int level = 0; level < num_levels_; ++level, scale *= factor_) {
      const double area = 1.0 / (scale * scale);
      pyramid.total_area += area;
      pyramid.area_up_to.push_back(pyramid.total_area);
      pyramid.sds.push_back(growth_ == 1.0 ? scale : std::pow(scale, growth_));
      pyramid.stated.push_back(std::pow(scale, stated_growth_));
      variance += growth_ == 1.0 ? 1.0 : area * pyramid.sds.back() * pyramid.sds.back();
      stated_variance += area * pyramid.stated.back() * pyramid.stated.back();
    }
    const double finest_px = sigma_px_ * std::sqrt(pyramid.total_area / variance);
    for (double& sd : pyramid.sds) sd = finest_px * sd;
    for (double& stated : pyramid.stated) stated *= std::sqrt(pyramid.total_area / stated_variance);
    return pyramid;
  }

  int num_levels_ = 8;  // with factor 1.2: ORB's pyramid
  double factor_ = 1.2;
  double growth_ = 1.0, stated_growth_ = 0.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeOctaveNoise() { return std::make_unique<OctaveNoise>(); }

}  // namespace rcme
