#include <algorithm>
#include <array>

#include "simulator/noise/noise_laws.h"

namespace rcme {
namespace {

class GaussianNoise : public NoiseModel {
 public:
  explicit GaussianNoise(double sigma_px) { sigma_px_ = sigma_px; }
  std::vector<Parameter> Parameters() override { return {SigmaParameter(&sigma_px_)}; }

  void AddTo(std::span<Correspondence> matches, RandomStream& rng) const override {
    constexpr size_t kBlock = 64;  // matches
    std::array<double, 4 * kBlock> normals;
    for (size_t first = 0; first < matches.size(); first += kBlock) {
      const std::span<Correspondence> block =
          matches.subspan(first, std::min(kBlock, matches.size() - first));
      rng.FillNormal(std::span(normals).first(4 * block.size()));
      const double* e = normals.data();
      for (Correspondence& match : block) {
        match.x1_px += Eigen::Vector2d(e[0] * sigma_px_, e[1] * sigma_px_);
        match.x2_px += Eigen::Vector2d(e[2] * sigma_px_, e[3] * sigma_px_);
        e += 4;
      }
    }
  }
};

}  // namespace

std::unique_ptr<NoiseModel> MakeGaussianNoise(double sigma_px) {
  return std::make_unique<GaussianNoise>(sigma_px);
}

}  // namespace rcme
