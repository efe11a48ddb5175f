#include <cmath>

#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Camera 2 looks at the same point on the optical axis of camera 1, from the same distance. The angle of the
// orbit and the baseline give the distance: baseline = 2 distance sin(angle / 2).
class Orbit : public MotionModel {
 public:
  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {
        Parameter::Real("orbit_deg", &orbit_deg_, {1e-6, 120.0}, "deg", "horizontal, to either side")};
    const std::vector<Parameter> more = rcme::Parameters(baseline_);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Baseline* MutableBaseline() override { return &baseline_; }

  Motion Draw(RandomStream& rng) const override {
    const double side = rng.Uniform() < 0.5 ? -1.0 : 1.0;
    const double angle = RadFromDeg(side * orbit_deg_);
    // In camera 1 the chord points sideways, turned by half the angle towards the point. Camera 2 has turned
    // back by the whole angle, so seen from it the chord to camera 1 is also turned by half the angle towards
    // the point.
    const Eigen::Matrix3d R = RotationFromVector({0.0, angle, 0.0});
    const Eigen::Vector3d centre2_in_cam1(std::cos(0.5 * angle) * side, 0.0, std::abs(std::sin(0.5 * angle)));
    return {{R, -(R * centre2_in_cam1).normalized()}, baseline_.Length()};
  }

 private:
  double orbit_deg_ = 6.0;
  Baseline baseline_;
};

}  // namespace

std::unique_ptr<MotionModel> MakeOrbit() { return std::make_unique<Orbit>(); }

}  // namespace rcme
