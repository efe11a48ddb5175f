#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "simulator/noise/coordinates.h"
#include "simulator/noise/noise_laws.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

constexpr int kNumWaves = 64;

// A field of displacements over one image whose covariance along x and along y each is exp(-d / reach): waves
//
//   f(x) = K^-1/2 sum_k a_k cos(w_k' x) + b_k sin(w_k' x),  a_k, b_k standard normal,
//
// have given the w the covariance 1 / K sum cos(w_k' (x - y)), whose mean over w is the characteristic
// function of their law at x - y (Bochner; Rahimi and Recht 2007). exp(-|d| / reach) is that of Cauchy's law
// in two dimensions, w = (z_1, z_2) / (|z_0| reach) of standard normals z: Student's t of one degree of
// freedom.
class DisplacementField {
 public:
  DisplacementField(double reach_px, RandomStream& rng) {
    for (Wave& wave : waves_) {
      const double divisor = 2.0 * std::numbers::pi * reach_px * std::max(std::abs(rng.Normal()), 1e-6);
      for (double* turns : {&wave.turns_per_px.x(), &wave.turns_per_px.y()}) *turns = rng.Normal() / divisor;
      for (Eigen::Vector2d* amplitude : {&wave.cosine, &wave.sine}) {
        amplitude->x() = rng.Normal();
        amplitude->y() = rng.Normal();
      }
    }
  }

  Eigen::Vector2d At(const Eigen::Vector2d& x_px) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Wave& wave : waves_) {
      const double turns = wave.turns_per_px.x() * x_px.x() + wave.turns_per_px.y() * x_px.y();
      const CosSin at = PortableCosSinOfTurn(turns - std::floor(turns));
      sum += at.cos * wave.cosine + at.sin * wave.sine;
    }
    return sum / std::sqrt(static_cast<double>(kNumWaves));
  }

 private:
  struct Wave {
    Eigen::Vector2d turns_per_px, cosine, sine;
  };
  std::array<Wave, kNumWaves> waves_;
};

// Normal noise of which a share is a field over each image, drawn anew in every trial: what a lens leaves,
// air that moves, a rolling shutter under vibration. The rest is each point's own.
class DisplacementFieldNoise : public NoiseModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {
        SigmaParameter(&sigma_px_),
        Parameter::Real("displacement_share", &share_, {0.0, 1.0}, "",
                        "share of the noise's variance that is a field over the image, the same for all "
                        "points at one place"),
        Parameter::Real("displacement_reach_px", &reach_px_, {0.1, 1e5}, "px",
                        "distance at which the field's correlation, exp(-d / reach), has fallen to 0.37")};
  }
  double sigma_px() const override { return sigma_px_; }

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
  double sigma_px_ = 0.5, share_ = 0.2, reach_px_ = 100.0;
};

}  // namespace

std::unique_ptr<NoiseModel> MakeDisplacementFieldNoise() {
  return std::make_unique<DisplacementFieldNoise>();
}

}  // namespace rcme
