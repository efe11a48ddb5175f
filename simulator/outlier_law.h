#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "simulator/camera_defects.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

// The input and output of an outlier law. matches[i] is the noisy match of the scene's point shown[i], which
// is i unless the noise law detects points several times.
struct MatchedScene {
  const Scene& scene;
  const CameraDefects& defects;  // of both images, for wrong matches as for right ones
  std::span<const std::uint32_t> shown;
  std::span<const std::uint32_t> inliers;  // points whose matches stay true, in random order
  std::span<Correspondence> matches;
  // Set this for wrong matches that satisfy the true epipolar constraint: no epipolar test can detect them.
  std::vector<bool>& is_undetectable;
  std::span<const Correspondence> exact;  // the matches before noise
};

// A law of wrong matches: the interface of the files in simulator/outliers. Configured once, then const and
// shared by threads.
class OutlierLaw {
 public:
  virtual ~OutlierLaw() = default;
  // The parameters by name; valid as long as the law lives.
  virtual std::vector<Parameter> Parameters() { return {}; }
  // Makes the matches of `points` (disjoint from the inliers, in random order) wrong. Without points it draws
  // nothing and throws nothing. Except for noise both ends stay in their images. Throws InputError that names
  // the keys if that is impossible.
  virtual void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
                       RandomStream& rng) const = 0;
};

// Maximum number of draws for one outlier. If none fits, less than about 0.1 % of the draws do, and the law
// is impossible.
inline constexpr int kMaxOutlierDraws = 10'000;

// The noise of a point's match (px), for laws that move the match and keep its noise. Call it before the
// match is changed.
inline Correspondence ComputeMatchNoise(const MatchedScene& matched, std::uint32_t point) {
  const Correspondence& exact = matched.exact[point];
  return {matched.matches[point].x1_px - exact.x1_px, matched.matches[point].x2_px - exact.x2_px};
}

// The scene point (camera 1's frame, m) that a match shows.
inline const Eigen::Vector3d& ShownPoint(const MatchedScene& matched, std::uint32_t match) {
  return matched.scene.points_in_cam1[matched.shown[match]];
}

// A parameter shared by several laws.
inline Parameter MinShiftParameter(double* min_shift_px) {
  return Parameter::Real("outlier_min_shift_px", min_shift_px, {0.0, 1e5}, "px",
                         "least distance of the wrong from the true point, before noise");
}

// Uniform over the image, whose border runs half a pixel outside the outermost pixel centres. With a lens:
// uniform over the pixels that a ray reaches, which are numerous in every image that shows a point.
inline Eigen::Vector2d DrawPixel(const SceneCamera& camera, RandomStream& rng) {
  Eigen::Vector2d x_px;
  for (int draw = 0; draw < kMaxOutlierDraws; ++draw) {
    x_px.x() = rng.Uniform(-0.5, camera.width - 0.5);
    x_px.y() = rng.Uniform(-0.5, camera.height - 0.5);
    if (!camera.HasLens() || camera.IsInImage(x_px)) break;
  }
  return x_px;
}

}  // namespace rcme
