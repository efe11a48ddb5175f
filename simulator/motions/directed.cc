#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "simulator/motions/motions.h"
#include "stats/constants.h"

namespace rcme {
namespace {

// x reflected into [0, high]; it may lie outside by at most `high`.
double Reflected(double x, double high) { return x < 0.0 ? -x : x > high ? 2.0 * high - x : x; }

// A symmetric random step on the unit sphere: the step back is equally likely.
Eigen::Vector3d NearDirection(const Eigen::Vector3d& direction, double step, RandomStream& rng) {
  const double x = rng.Normal(), y = rng.Normal(), z = rng.Normal();
  return (direction + step * Eigen::Vector3d(x, y, z)).normalized();
}

// Camera 2 lies in the direction of an axis of camera 1, uniform in a cone around it.
class DirectedMotion : public MotionModel {
 public:
  DirectedMotion(const Eigen::Vector3d& axis, bool is_either_way)
      : axis_(axis), is_either_way_(is_either_way) {}

  std::vector<Parameter> Parameters() override {
    std::vector<Parameter> all = {
        Parameter::Real("max_rotation_deg", &max_rotation_deg_, {0.0, 180.0}, "deg",
                        "greatest rotation, uniform from 0"),
        Parameter::Real("max_deviation_deg", &max_deviation_deg_, {0.0, 90.0}, "deg",
                        "half angle of the cone around the axis that holds camera 2")};
    const std::vector<Parameter> more = rcme::Parameters(baseline_);
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  Baseline* MutableBaseline() override { return &baseline_; }

  Motion Draw(RandomStream& rng) const override {
    const Eigen::Matrix3d R = DrawRotation(max_rotation_deg_ * kRadPerDeg, rng);
    const Eigen::Vector3d axis = is_either_way_ && rng.Uniform() < 0.5 ? Eigen::Vector3d(-axis_) : axis_;
    // Uniform on the cap: the height is uniform.
    const double height = rng.Uniform(RimOfCone(), 1.0);
    const Eigen::Vector3d sideways = DrawSideways(axis, rng);
    const Eigen::Vector3d centre2_in_cam1 = height * axis + std::sqrt(1.0 - height * height) * sideways;
    return {{R, -(R * centre2_in_cam1).normalized()}, baseline_.Length()};
  }

  // Each part moves separately. The angle of the rotation is uniform: it takes a uniform step, reflected at
  // the bounds. The axis is uniform on the sphere. The direction is uniform on its cap; steps that leave the
  // cap are rejected (Metropolis).
  std::optional<Motion> DrawNear(const Motion& motion, double step, RandomStream& rng) const override {
    const Eigen::Matrix3d& R_before = motion.cam2_from_cam1.R;
    const Eigen::AngleAxisd before(R_before);
    const double max_angle = max_rotation_deg_ * kRadPerDeg;
    const double angle = Reflected(before.angle() + step * max_angle * rng.Uniform(-1.0, 1.0), max_angle);
    const Eigen::Matrix3d R = RotationFromVector(angle * NearDirection(before.axis(), step, rng));

    const Eigen::Vector3d centre_before = -(R_before.transpose() * motion.cam2_from_cam1.t);
    const double side = is_either_way_ && axis_.dot(centre_before) < 0.0 ? -1.0 : 1.0;
    Eigen::Vector3d centre = NearDirection(centre_before, step * max_deviation_deg_ * kRadPerDeg, rng);
    if (side * axis_.dot(centre) < RimOfCone()) centre = centre_before;
    return Motion{{R, -(R * centre).normalized()}, motion.baseline_m};
  }

 private:
  // Height of the rim of the cone on the unit sphere.
  double RimOfCone() const { return std::cos(max_deviation_deg_ * kRadPerDeg); }

  // Uniform on the circle of unit vectors normal to `axis`.
  static Eigen::Vector3d DrawSideways(const Eigen::Vector3d& axis, RandomStream& rng) {
    const Eigen::Matrix<double, 3, 2> B = DirectionBasis(axis);
    const double angle = rng.Uniform(0.0, 2.0 * std::numbers::pi);
    return std::cos(angle) * B.col(0) + std::sin(angle) * B.col(1);
  }

  Eigen::Vector3d axis_;
  bool is_either_way_;
  double max_rotation_deg_ = 5.0, max_deviation_deg_ = 5.0;
  Baseline baseline_;
};

}  // namespace

std::unique_ptr<MotionModel> MakeForwardMotion() {
  return std::make_unique<DirectedMotion>(Eigen::Vector3d::UnitZ(), false);
}
std::unique_ptr<MotionModel> MakeSidewaysMotion() {
  return std::make_unique<DirectedMotion>(Eigen::Vector3d::UnitX(), true);
}

}  // namespace rcme
