#include <fmt/format.h>

#include "parameters/input_error.h"
#include "simulator/scenes/scenes.h"

namespace rcme {
namespace {

// Points whose first image is uniform over image 1 and whose depth is uniform in a range.
class UniformVolumeWorld : public World {
 public:
  UniformVolumeWorld(const Camera& camera1, double min_depth_m, double max_depth_m)
      : camera_(camera1), min_depth_m_(min_depth_m), max_depth_m_(max_depth_m) {}

  // Three uniforms a point: its y in image 1, x in image 1, depth. A plain loop over arrays, which the
  // compiler turns into vectors.
  void DrawCandidates(size_t, RandomStream& rng, PointBlock* block) const override {
    std::array<double, 3 * PointBlock::kSize> uniforms;
    rng.FillUniform(uniforms);
    const double width_px = camera_.width, height_px = camera_.height;
    const double depth_span_m = max_depth_m_ - min_depth_m_;
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      const double depth_m = min_depth_m_ + depth_span_m * uniforms[3 * i + 2];
      block->x_m[i] = depth_m * ((-0.5 + width_px * uniforms[3 * i + 1] - camera_.cx) / camera_.fx);
      block->y_m[i] = depth_m * ((-0.5 + height_px * uniforms[3 * i] - camera_.cy) / camera_.fy);
      block->z_m[i] = depth_m;
    }
  }

 private:
  Camera camera_;
  double min_depth_m_, max_depth_m_;
};

class UniformVolume : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("min_depth_m", &min_depth_m_, {1e-6, 1e9}, "m", "least depth in camera 1"),
            Parameter::Real("max_depth_m", &max_depth_m_, {1e-6, 1e9}, "m", "greatest depth in camera 1")};
  }
  double TypicalDepth() const override { return 0.5 * (min_depth_m_ + max_depth_m_); }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream&) const override {
    if (min_depth_m_ > max_depth_m_) {
      throw InputError(fmt::format("min_depth_m: {} is not allowed; give at most max_depth_m = {}",
                                   min_depth_m_, max_depth_m_));
    }
    return std::make_unique<UniformVolumeWorld>(view.camera1, min_depth_m_, max_depth_m_);
  }

 private:
  double min_depth_m_ = 2.0, max_depth_m_ = 8.0;
};

}  // namespace

std::unique_ptr<SceneModel> MakeUniformVolume() { return std::make_unique<UniformVolume>(); }

}  // namespace rcme
