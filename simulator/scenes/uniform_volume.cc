#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

class UniformVolumeWorld : public World {
 public:
  UniformVolumeWorld(const SceneCamera& camera1, const DepthRange& depths)
      : camera_(camera1), depths_(depths) {}

  void DrawCandidates(size_t, size_t, RandomStream& rng, PointBlock* block) const override {
    DrawInViewVolume(camera_, depths_, rng, block);
  }

 private:
  SceneCamera camera_;
  DepthRange depths_;
};

class UniformVolume : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override { return rcme::Parameters(depths_); }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream&) const override {
    depths_.Check();
    return std::make_unique<UniformVolumeWorld>(view.camera1, depths_);
  }

 private:
  DepthRange depths_;
};

}  // namespace

std::unique_ptr<SceneModel> MakeUniformVolume() { return std::make_unique<UniformVolume>(); }

}  // namespace rcme
