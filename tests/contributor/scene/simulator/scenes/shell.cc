#include "simulator/scenes/scenes.h"
#include "simulator/scenes/view_volume.h"

namespace rcme {
namespace {

// On the viewing ray of a pixel uniform over image 1, at a distance uniform within the shell.
class ShellWorld : public PointwiseWorld {
 public:
  ShellWorld(const SceneCamera& camera1, double radius_m, double thickness_m)
      : camera_(camera1), radius_m_(radius_m), thickness_m_(thickness_m) {}

 private:
  Eigen::Vector3d DrawCandidate(size_t, RandomStream& rng) const override {
    const Eigen::Vector3d ray = DrawRay(camera_, rng);
    return rng.Uniform(radius_m_, radius_m_ + thickness_m_) * ray.normalized();
  }

  SceneCamera camera_;
  double radius_m_, thickness_m_;
};

class Shell : public SceneModel {
 public:
  std::vector<Parameter> Parameters() override {
    return {Parameter::Real("shell_radius_m", &radius_m_, {1e-6, 1e9}, "m",
                            "least distance of a point from camera 1"),
            Parameter::Real("shell_thickness_m", &thickness_m_, {1e-6, 1e9}, "m",
                            "greatest distance less the least, uniform between them")};
  }

  std::unique_ptr<const World> DrawWorld(const ViewPair& view, RandomStream&) const override {
    return std::make_unique<ShellWorld>(view.camera1, radius_m_, thickness_m_);
  }

 private:
  double radius_m_ = 4.0, thickness_m_ = 2.0;
};

}  // namespace

std::unique_ptr<SceneModel> MakeShell() { return std::make_unique<Shell>(); }

}  // namespace rcme
