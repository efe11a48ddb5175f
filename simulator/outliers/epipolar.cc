#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "parameters/input_error.h"
#include "simulator/exact_match.h"
#include "simulator/outliers/outlier_laws.h"

namespace rcme {
namespace {

// The part of a viewing ray of camera 1 that image 2 shows. Up to the factor z, the ray's point at inverse
// depth w = 1 / z is P + w Q in camera 2's frame, P = R ray, Q = the translation (m). w runs from 0
// (infinitely far) to infinity (camera 1's centre).
struct VisibleRay {
  Eigen::Vector3d far_in_cam2, near_in_cam2;  // its ends, each up to a positive factor
  Eigen::Vector2d far_px, near_px;            // their images

  double Length() const { return (near_px - far_px).norm(); }
  // The ray's point whose image lies `from_far_px` along the line from the far to the near end, in camera 2
  // up to a positive factor. It is the weighted sum of the ends, each at depth 1 in camera 2, with weights
  // that sum to 1. The sum is a point of the ray, since its coefficients of P and Q are positive.
  Eigen::Vector3d DirectionAt(double from_far_px) const {
    const double share = from_far_px / Length();
    return (1.0 - share) / far_in_cam2.z() * far_in_cam2 + share / near_in_cam2.z() * near_in_cam2;
  }
};

// The distances of the point's pixel from the four borders of the image (px), times its depth in camera 2's
// frame. All are >= 0 if the image shows the point.
std::array<double, 4> BorderDistances(const Camera& camera, const Eigen::Vector3d& point_in_cam) {
  const double x = camera.fx * point_in_cam.x(), y = camera.fy * point_in_cam.y(), z = point_in_cam.z();
  return {x + (camera.cx + 0.5) * z, (camera.width - 0.5 - camera.cx) * z - x, y + (camera.cy + 0.5) * z,
          (camera.height - 0.5 - camera.cy) * z - y};
}

// The part of the ray through x1 that image 2 shows, which must not be empty. All borders are linear in w.
VisibleRay ClipToImage2(const ViewPair& view, const Eigen::Vector2d& x1_px) {
  const Eigen::Vector3d P = view.cam2_from_cam1_true.R * view.camera1.Ray(x1_px);
  const Eigen::Vector3d Q = view.baseline_m * view.cam2_from_cam1_true.t;
  const std::array<double, 4> at_P = BorderDistances(view.camera2, P),
                              at_Q = BorderDistances(view.camera2, Q);
  double w_far = 0.0, w_near = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < 4; ++i) {
    if (at_Q[i] > 0.0) w_far = std::max(w_far, -at_P[i] / at_Q[i]);
    if (at_Q[i] < 0.0) w_near = std::min(w_near, -at_P[i] / at_Q[i]);
  }
  VisibleRay ray;
  ray.far_in_cam2 = P + w_far * Q;
  ray.near_in_cam2 = std::isinf(w_near) ? Q : P + w_near * Q;  // infinite: image 2 shows the epipole
  ray.far_px = view.camera2.Project(ray.far_in_cam2);
  ray.near_px = view.camera2.Project(ray.near_in_cam2);
  return ray;
}

// With a lens the image of a ray is a curve, which may leave image 2 and come back. Draws a point uniform
// along the curve, except within min_shift_px of the true one; nullopt if no place is left. The curve is
// approximated by a polygon whose sides count if both their ends do. The directions of its corners are (1 -
// s) P + s Q, P and Q of unit length, s = 0, 1 / 256, ... 1, which are points of the ray as above.
std::optional<Eigen::Vector3d> DrawOnCurve(const ViewPair& view, const Correspondence& exact,
                                           double min_shift_px, RandomStream& rng) {
  constexpr int kSides = 256;
  const SceneCamera& camera2 = view.camera2;
  const Eigen::Vector3d P = (view.cam2_from_cam1_true.R * view.camera1.Ray(exact.x1_px)).normalized();
  const auto direction = [&](double s) {
    return Eigen::Vector3d((1.0 - s) * P + s * view.cam2_from_cam1_true.t);
  };
  const auto is_place = [&](double s) {
    return camera2.Shows(direction(s)) &&
           (camera2.Project(direction(s)) - exact.x2_px).norm() >= min_shift_px;
  };
  std::array<double, kSides + 1> up_to_px{};  // length of the sides that count, up to each corner
  bool was_place = is_place(0.0);
  for (size_t i = 1; i <= kSides; ++i) {
    const double s = 1.0 * static_cast<double>(i) / kSides, before = s - 1.0 / kSides;
    const bool is_now = is_place(s);
    up_to_px[i] = up_to_px[i - 1];
    if (was_place && is_now)
      up_to_px[i] += (camera2.Project(direction(s)) - camera2.Project(direction(before))).norm();
    was_place = is_now;
  }
  if (!(up_to_px[kSides] > 0.0)) return std::nullopt;
  const double place_px = rng.Uniform(0.0, up_to_px[kSides]);
  const auto end = std::ranges::upper_bound(up_to_px, place_px);
  if (end == up_to_px.end()) return std::nullopt;
  const double side = static_cast<double>(end - up_to_px.begin() - 1);
  const double s = (side + (place_px - *(end - 1)) / (*end - *(end - 1))) / kSides;
  if (!is_place(s)) return std::nullopt;  // the side leaves the image between its ends
  return direction(s);
}

// The image 2 of the point of the ray of x1_px that camera 2, without defects, sees in a direction of the
// plane of ray and baseline. x1_px: image 1 of `point_in_cam1`, a point of the ray.
Eigen::Vector2d ImageOnRay(const ViewPair& view, const CameraDefects& defects,
                           const Eigen::Vector3d& point_in_cam1, const Eigen::Vector2d& x1_px,
                           const Eigen::Vector3d& direction_in_cam2) {
  if (defects.IsNone()) return view.camera2.Project(direction_in_cam2);
  // distance R ray + T is along the direction: crossed with it, distance (R ray x d) = -(T x d).
  const Eigen::Vector3d ray = point_in_cam1.normalized(),
                        a = (view.cam2_from_cam1_true.R * ray).cross(direction_in_cam2),
                        b = -view.baseline_m * view.cam2_from_cam1_true.t.cross(direction_in_cam2);
  const double farthest_m =
      1e6 * (point_in_cam1.norm() + view.baseline_m);  // in place of an infinite distance
  const double distance_m = std::clamp(a.dot(b) / std::max(a.squaredNorm(), 1e-300), 0.0, farthest_m);
  return ImagedMatch(view, defects, PointOnSameRay(view, defects, point_in_cam1, x1_px, distance_m)).x2_px;
}

// The point in image 2 is that of another point on the viewing ray of the exact x1. Image 2 shows a segment
// of the ray; the point is uniform on it, except within outlier_min_shift_px of the true one. (For a sideways
// motion without rotation this is uniform in inverse depth.) The match keeps its noise.
//
// If image 2 shows too little of the ray, as near the direction of the motion, there is no such place. The
// match then moves, in image 1 too, to the ray of another scene point drawn at random.
class EpipolarOutliers : public OutlierLaw {
 public:
  std::vector<Parameter> Parameters() override { return {MinShiftParameter(&min_shift_px_)}; }

  void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
               RandomStream& rng) const override {
    const Scene& scene = matched.scene;
    if (!points.empty() && !scene.IsDirectionDefined()) {
      throw InputError(
          "outliers: 'epipolar' is not allowed without a baseline, there is no epipolar line; give another "
          "motion, "
          "or baseline_m > 0");
    }
    const auto num_points = static_cast<std::uint32_t>(scene.points_in_cam1.size());
    for (const std::uint32_t point : points) {
      const Correspondence noise = ComputeMatchNoise(matched, point);
      std::uint32_t on_ray_of = matched.shown[point];
      std::optional<Eigen::Vector3d> direction = DrawOnRay(scene, on_ray_of, rng);
      for (int draw = 0; !direction; ++draw) {
        if (draw == kMaxOutlierDraws) ThrowNoPlace();
        on_ray_of = rng.IntegerBelow(num_points);
        direction = DrawOnRay(scene, on_ray_of, rng);
      }
      const Eigen::Vector3d& on_ray = scene.points_in_cam1[on_ray_of];
      const Eigen::Vector2d x1_px = ImagedMatch(scene, matched.defects, on_ray).x1_px;
      if (x1_px != matched.exact[point].x1_px) matched.matches[point].x1_px = x1_px + noise.x1_px;
      matched.matches[point].x2_px =
          ImageOnRay(scene, matched.defects, on_ray, x1_px, *direction) + noise.x2_px;
      matched.is_undetectable[point] = true;
    }
  }

 private:
  // A place of the ray as a direction of camera 2; nullopt if the visible part of the ray leaves none.
  std::optional<Eigen::Vector3d> DrawOnRay(const Scene& scene, std::uint32_t point, RandomStream& rng) const {
    const Correspondence exact = ExactMatch(scene, scene.points_in_cam1[point]);
    if (scene.camera2.HasLens()) return DrawOnCurve(scene, exact, min_shift_px_, rng);
    const VisibleRay ray = ClipToImage2(scene, exact.x1_px);
    const double length_px = ray.Length(), true_px = (exact.x2_px - ray.far_px).norm();
    const double before_px = std::max(0.0, true_px - min_shift_px_);
    const double after_px = std::max(0.0, length_px - true_px - min_shift_px_);
    if (!(before_px + after_px > 0.0)) return std::nullopt;
    const double place_px = rng.Uniform(0.0, before_px + after_px);
    const double jump_px = place_px < before_px ? 0.0 : true_px + min_shift_px_ - before_px;
    return ray.DirectionAt(place_px + jump_px);
  }

  [[noreturn]] void ThrowNoPlace() const {
    throw InputError(
        fmt::format("outlier_min_shift_px: {}: no ray of {} has a place that far from the true point in "
                    "image 2; give less, or another motion or baseline_m",
                    min_shift_px_, kMaxOutlierDraws));
  }

  double min_shift_px_ = 5.0;
};

}  // namespace

std::unique_ptr<OutlierLaw> MakeEpipolarOutliers() { return std::make_unique<EpipolarOutliers>(); }

}  // namespace rcme
