#include <fmt/format.h>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

// Depth of the farthest far points over far_depth_m.
constexpr double kFarSpan = 10.0;

// Part 0: a near uniform volume. Part 1: a far one.
class FarPointsWorld : public World {
 public:
  FarPointsWorld(const SceneCamera& camera1, const DepthRange& near, const DepthRange& far, double far_share)
      : camera_(camera1), near_(near), far_(far), far_share_(far_share) {}

  std::vector<double> PartShares() const override { return {1.0 - far_share_, far_share_}; }

  void DrawCandidates(size_t part, size_t, RandomStream& rng, PointBlock* block) const override {
    DrawInViewVolume(camera_, part == 0 ? near_ : far_, rng, block);
  }

 private:
  SceneCamera camera_;
  DepthRange near_, far_;
  double far_share_;
};

// A near volume and points so far away that their parallax is below the noise: these determine the rotation,
// but not the translation.
class FarPoints : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = rcme::Parameters(near_);
    all.push_back(Parameter::Real("far_share", &far_share_, {0.0, 1.0}, "", "share of far points"));
    all.push_back(Parameter::Real("far_depth_m", &far_depth_m_, {1e-6, 1e12}, "m",
                                  "least depth of far points, uniform up to ten times that"));
    return all;
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream&) const override {
    near_.Check();
    if (far_depth_m_ < near_.max_depth_m) {
      throw InputError(fmt::format("far_depth_m: {} is not allowed; give at least max_depth_m = {}",
                                   far_depth_m_, near_.max_depth_m));
    }
    const DepthRange far{far_depth_m_, kFarSpan * far_depth_m_};
    return std::make_unique<FarPointsWorld>(view.camera1, near_, far, far_share_);
  }

 private:
  DepthRange near_;
  double far_share_ = 0.5, far_depth_m_ = 1e4;
};

}  // namespace

std::unique_ptr<SceneModel> MakeFarPoints() { return std::make_unique<FarPoints>(); }

}  // namespace rcme
