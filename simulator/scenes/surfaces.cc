#include "simulator/scenes/surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "simulator/scene_model.h"
#include "simulator/scenes/view_volume.h"
#include "stats/portable_math.h"

namespace rcme {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

// The multiple of `direction` at which the ray from `start` meets the rectangle; infinite if it does not.
double MultipleAt(const Rectangle& rectangle, const Eigen::Vector3d& start,
                  const Eigen::Vector3d& direction) {
  const int n = rectangle.normal_axis;
  const double multiple = (rectangle.low(n) - start(n)) / direction(n);
  if (!(multiple > 0.0 && multiple < kNone)) return kNone;  // behind, or parallel to the rectangle
  for (const int k : {(n + 1) % 3, (n + 2) % 3}) {
    const double coordinate = start(k) + multiple * direction(k);
    if (coordinate < rectangle.low(k) || coordinate > rectangle.high(k)) return kNone;
  }
  return multiple;
}

}  // namespace

UprightCamera::UprightCamera(const SceneCamera& camera, const Eigen::Vector3d& centre_in_building,
                             double turn)
    : camera_(camera), centre_(centre_in_building) {
  const CosSin angle = PortableCosSinOfTurn(std::abs(turn));
  cos_turn_ = angle.cos;
  sin_turn_ = turn < 0.0 ? -angle.sin : angle.sin;
}

Eigen::Vector3d UprightCamera::InBuildingAxes(const Eigen::Vector3d& ray) const {
  return {cos_turn_ * ray.x() + sin_turn_ * ray.z(), ray.y(), cos_turn_ * ray.z() - sin_turn_ * ray.x()};
}

// The ray's third component is 1, so its multiple is the depth.
double UprightCamera::FirstDepth(const Eigen::Vector3d& ray, std::span<const Rectangle> rectangles) const {
  const Eigen::Vector3d direction = InBuildingAxes(ray);
  double first = kNone;
  for (const Rectangle& rectangle : rectangles) {
    first = std::min(first, MultipleAt(rectangle, centre_, direction));
  }
  return first;
}

Eigen::Vector3d UprightCamera::DrawPoint(std::span<const Rectangle> rectangles, RandomStream& rng) const {
  const Eigen::Vector3d ray = DrawRay(camera_, rng);
  const double depth_m = FirstDepth(ray, rectangles);
  return depth_m < kNone ? Eigen::Vector3d(depth_m * ray) : UnseenPoint();
}

double DrawTurn(double max_deg, RandomStream& rng) { return rng.Uniform(-max_deg, max_deg) / 360.0; }

}  // namespace rcme
