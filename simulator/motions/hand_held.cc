
#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// Yaw has the full standard deviation, pitch and roll half of it. The camera moves across its view (x and y)
// more than along it (z).
class HandHeld : public MotionModel {
 public:
  HandHeld() { baseline_.baseline_m = 0.2; }

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {
        Parameter::Real("rotation_sd_deg", &rotation_sd_deg_, {0.0, 60.0}, "deg",
                        "standard deviation of yaw; half of it for pitch and roll")};
    const std::vector<Parameter> more = rcme::Parameters(baseline_);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Baseline* MutableBaseline() override { return &baseline_; }

  Motion Draw(RandomStream& rng) const override {
    const double sd = RadFromDeg(rotation_sd_deg_);
    const double yaw = sd * rng.Normal(), pitch = 0.5 * sd * rng.Normal(), roll = 0.5 * sd * rng.Normal();
    const Eigen::Matrix3d R = RotationFromVector({pitch, yaw, roll});
    const double x = rng.Normal(), y = 0.6 * rng.Normal(), z = 0.5 * rng.Normal();
    return {{R, Eigen::Vector3d(x, y, z).normalized()}, baseline_.Length()};
  }

 private:
  double rotation_sd_deg_ = 4.0;
  Baseline baseline_;
};

}  // namespace

std::unique_ptr<MotionModel> MakeHandHeld() { return std::make_unique<HandHeld>(); }

}  // namespace rcme
