#include <cmath>

#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// The motion of a camera above the rear axle of a car that drives a circular arc on flat ground and turns
// right by `yaw`. The chord of the arc makes half the yaw angle with the initial heading (Scaramuzza et al.
// 2009).
RelativePose ArcPose(double yaw) {
  const Eigen::Matrix3d R = RotationFromVector({0.0, -yaw, 0.0});  // y points down: a right turn is positive
  const Eigen::Vector3d centre2_in_cam1(std::sin(0.5 * yaw), 0.0, std::cos(0.5 * yaw));
  return {R, -(R * centre2_in_cam1).normalized()};
}

class Ackermann : public MotionModel {
 public:
  // `jitter_deg` is the standard deviation of pitch, of roll, and of the direction's deviation from the arc.
  explicit Ackermann(double jitter_deg) : is_jittered_(jitter_deg > 0.0), jitter_deg_(jitter_deg) {
    baseline_.baseline_m = 1.0;  // 36 km/h at 10 images a second
  }

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {Parameter::Real("max_yaw_deg", &max_yaw_deg_, {0.0, 90.0}, "deg",
                                                  "greatest yaw, uniform to either side")};
    if (is_jittered_) {
      all.push_back(Parameter::Real("jitter_deg", &jitter_deg_, {0.0, 45.0}, "deg",
                                    "standard deviation of pitch, roll and both angles of slip"));
    }
    const std::vector<Parameter> more = rcme::Parameters(baseline_);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Baseline* MutableBaseline() override { return &baseline_; }

  Motion Draw(RandomStream& rng) const override {
    RelativePose pose = ArcPose(rng.Uniform(-max_yaw_deg_, max_yaw_deg_) * kRadPerDeg);
    if (is_jittered_) {
      const double sd = jitter_deg_ * kRadPerDeg;
      Vector5d jitter = Vector5d::Zero();
      for (const int k : {0, 2, 3, 4}) jitter(k) = sd * rng.Normal();  // pitch, roll, direction
      pose = Retract(pose, jitter);
    }
    return {pose, baseline_.Length()};
  }

 private:
  bool is_jittered_;
  double jitter_deg_;
  double max_yaw_deg_ = 5.0;
  Baseline baseline_;
};

}  // namespace

std::unique_ptr<MotionModel> MakeAckermann() { return std::make_unique<Ackermann>(0.0); }
std::unique_ptr<MotionModel> MakeVehicle() { return std::make_unique<Ackermann>(0.5); }

}  // namespace rcme
