#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "estimator/geometry/correspondence.h"
#include "parameters/parameter.h"
#include "simulator/scene.h"
#include "stats/random.h"

namespace rcme {

// What an outlier law may see and change: the noisy matches of all points, matches[i] that of
// scene.points_in_cam1[i].
struct MatchedScene {
  const Scene& scene;
  std::span<const std::uint32_t> inliers;  // points whose matches stay true
  std::span<Correspondence> matches;
  // To be set for wrong matches that satisfy the true epipolar constraint: no epipolar test can tell them.
  std::vector<bool>& is_undetectable;
};

// How a wrong match comes about: the plug-in contract of simulator/outliers. Configured once, then const and
// shared by threads.
class OutlierLaw {
 public:
  virtual ~OutlierLaw() = default;
  // The parameters by name; valid as long as the law lives.
  virtual std::vector<Parameter> Parameters() { return {}; }
  // Makes the matches of `points` (disjoint from the inliers, in random order) wrong. Both ends stay in their
  // images, but for noise. Throws InputError that names the keys if that is impossible.
  virtual void Replace(std::span<const std::uint32_t> points, const MatchedScene& matched,
                       RandomStream& rng) const = 0;
};

// Uniform over the image, whose border runs half a pixel outside the outermost pixel centres.
inline Eigen::Vector2d DrawPixel(const Camera& camera, RandomStream& rng) {
  const double x = rng.Uniform(-0.5, camera.width - 0.5);
  const double y = rng.Uniform(-0.5, camera.height - 0.5);
  return {x, y};
}

}  // namespace rcme
