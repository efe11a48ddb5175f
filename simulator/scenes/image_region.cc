#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

enum class Region { kHalf, kCorner, kBand, kFull };

// A rectangle of image 1, in fractions of the image's sides from the left and the upper border.
struct ImagePart {
  double left = 0.0, width = 1.0, top = 0.0, height = 1.0;
};

ImagePart PartOfImage(Region region, double share) {
  switch (region) {
    case Region::kHalf:
      return {0.0, share, 0.0, 1.0};
    case Region::kCorner:
      return {0.0, std::sqrt(share), 0.0, std::sqrt(share)};
    case Region::kBand:
      return {0.0, 1.0, 0.5 * (1.0 - share), share};
    case Region::kFull:
      break;
  }
  return {};
}

double UsualShare(Region region) {
  switch (region) {
    case Region::kHalf:
      return 0.5;
    case Region::kCorner:
    case Region::kBand:
      return 0.25;
    case Region::kFull:
      break;
  }
  return 1.0;
}

class ImageRegionWorld : public PointwiseWorld {
 public:
  ImageRegionWorld(const SceneCamera& camera1, const ImagePart& part, const DepthRange& depths)
      : camera_(camera1), part_(part), depths_(depths) {}

 private:
  Eigen::Vector3d DrawCandidate(size_t, RandomStream& rng) const override {
    const double y_px = -0.5 + camera_.height * (part_.top + part_.height * rng.Uniform());
    const double x_px = -0.5 + camera_.width * (part_.left + part_.width * rng.Uniform());
    return depths_.Draw(rng) * camera_.Ray({x_px, y_px});
  }

  SceneCamera camera_;
  ImagePart part_;
  DepthRange depths_;
};

// All matches in one rectangle of image 1: texture on one side, in a corner, or in a band across.
class ImageRegion : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(depths_);
    all.push_back(Parameter::Choice<Region>(
        "region", &region_,
        {{"half", Region::kHalf},
         {"corner", Region::kCorner},
         {"band", Region::kBand},
         {"full", Region::kFull}},
        "of image 1: left, upper left corner of the image's shape, level middle band, or all"));
    all.push_back(Parameter::RealOrWord("region_share", &region_share_, {1e-6, 1.0}, "usual", "",
                                        "share of image 1; usual: half 0.5, corner and band 0.25, full 1"));
    return all;
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream&) const override {
    depths_.Check();
    const double share = std::isnan(region_share_) ? UsualShare(region_) : region_share_;
    if (region_ == Region::kFull && share != 1.0) {
      throw InputError(
          fmt::format("region_share: {} is not allowed; with region = full give usual or 1", region_share_));
    }
    return std::make_unique<ImageRegionWorld>(view.camera1, PartOfImage(region_, share), depths_);
  }

 private:
  DepthRange depths_;
  Region region_ = Region::kHalf;
  double region_share_ = std::numeric_limits<double>::quiet_NaN();  // NaN: usual
};

}  // namespace

std::unique_ptr<SceneModel> MakeImageRegion() { return std::make_unique<ImageRegion>(); }

}  // namespace rcme
