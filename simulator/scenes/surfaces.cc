#include "simulator/scenes/surfaces.h"

#include <cmath>
#include <limits>

#include "stats/portable_math.h"

namespace rcme {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();

using Numbers = RayBlock::Numbers;

// Directions in the axes of the building.
using Directions = std::array<Numbers, 3>;

// Lowers each ray's multiple of its direction to that at which the ray from `start` meets the rectangle. The
// compiler vectorises the loop: it has no branch, and comparisons with NaN are false.
void MeetRectangle(const Rectangle& rectangle, const Eigen::Vector3d& start, const Directions& directions,
                   Numbers* first_multiple) {
  const int n = rectangle.normal_axis, k = (n + 1) % 3, l = (n + 2) % 3;
  const double distance = rectangle.low(n) - start(n), start_k = start(k), start_l = start(l);
  const double low_k = rectangle.low(k), high_k = rectangle.high(k);
  const double low_l = rectangle.low(l), high_l = rectangle.high(l);
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const double multiple = distance / directions[n][i], first = (*first_multiple)[i];
    const double at_k = start_k + multiple * directions[k][i];
    const double at_l = start_l + multiple * directions[l][i];
    const bool is_met = (multiple > 0.0) & (multiple < first) & (at_k >= low_k) & (at_k <= high_k) &
                        (at_l >= low_l) & (at_l <= high_l);
    (*first_multiple)[i] = is_met ? multiple : first;
  }
}

// Whether all of the rectangle lies clearly outside a plane through `start` with this outward normal: by more
// than rounding can move it.
bool IsOutside(const Rectangle& rectangle, const Eigen::Vector3d& start, const Eigen::Vector3d& normal) {
  constexpr double kRounding = 1e-9;
  const Eigen::Vector3d low = normal.cwiseProduct(rectangle.low - start);
  const Eigen::Vector3d high = normal.cwiseProduct(rectangle.high - start);
  const Eigen::Vector3d size =
      rectangle.low.cwiseAbs().cwiseMax(rectangle.high.cwiseAbs()) + start.cwiseAbs();
  return low.cwiseMin(high).sum() > kRounding * normal.cwiseAbs().dot(size);
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

// The image's rays lie within five planes: those through its sides, and that of depth 0.
std::vector<Rectangle> UprightCamera::InView(std::vector<Rectangle> rectangles) const {
  if (camera_.HasLens()) return rectangles;
  const Eigen::Vector3d ray1 = camera_.Ray({-0.5, -0.5});
  const Eigen::Vector3d ray2 = camera_.Ray({camera_.width - 0.5, camera_.height - 0.5});
  const Eigen::Vector3d least = ray1.cwiseMin(ray2), greatest = ray1.cwiseMax(ray2);
  for (const Eigen::Vector3d& normal :
       {Eigen::Vector3d(-1, 0, least.x()), Eigen::Vector3d(1, 0, -greatest.x()),
        Eigen::Vector3d(0, -1, least.y()), Eigen::Vector3d(0, 1, -greatest.y()), Eigen::Vector3d(0, 0, -1)}) {
    std::erase_if(rectangles, [&, outward = InBuildingAxes(normal)](const Rectangle& rectangle) {
      return IsOutside(rectangle, centre_, outward);
    });
  }
  return rectangles;
}

// The ray's third component is 1, so its multiple is the depth.
Numbers UprightCamera::FirstDepths(const RayBlock& rays, std::span<const Rectangle> rectangles) const {
  Directions directions;
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const Eigen::Vector3d direction = InBuildingAxes({rays.x[i], rays.y[i], 1.0});
    for (int k = 0; k < 3; ++k) directions[k][i] = direction(k);
  }
  Numbers depths_m;
  depths_m.fill(kNone);
  for (const Rectangle& rectangle : rectangles) MeetRectangle(rectangle, centre_, directions, &depths_m);
  return depths_m;
}

void UprightCamera::DrawPoints(std::span<const Rectangle> rectangles, RandomStream& rng,
                               PointBlock* block) const {
  RayBlock rays;
  DrawRays(camera_, rng, &rays);
  SetOnRays(rays, FirstDepths(rays, rectangles), block);
}

double DrawTurn(double max_deg, RandomStream& rng) { return rng.Uniform(-max_deg, max_deg) / 360.0; }

}  // namespace rcme
