#include "simulator/observe.h"

#include <numeric>

namespace rcme {
namespace {

Eigen::Vector2d DrawPixel(const Camera& camera, RandomStream& rng) {
  return {rng.Uniform(-0.5, camera.width - 0.5), rng.Uniform(-0.5, camera.height - 0.5)};
}

}  // namespace

Observation Observe(const Scene& scene, const NoiseModel& noise, const OutlierModel& outliers,
                    RandomStream& noise_rng, RandomStream& outlier_rng) {
  const size_t n = scene.points_in_cam1.size();
  std::vector<Correspondence> matches(n);
  for (size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d& point = scene.points_in_cam1[i];
    matches[i] = {scene.camera1.Project(point), scene.camera2.Project(scene.InCamera2(point))};
    for (double* coordinate :
         {&matches[i].x1_px.x(), &matches[i].x1_px.y(), &matches[i].x2_px.x(), &matches[i].x2_px.y()}) {
      *coordinate += noise.Draw(noise_rng);
    }
  }
  // A random order; the first matches in it become mismatches, then the list is read in a second random
  // order.
  std::vector<size_t> order(n);
  std::iota(order.begin(), order.end(), size_t{0});
  outlier_rng.Shuffle(std::span(order));
  const size_t num_outliers = static_cast<size_t>(outliers.CountOf(static_cast<int>(n)));
  std::vector<bool> is_inlier(n, true);
  for (size_t k = 0; k < num_outliers; ++k) {
    matches[order[k]].x2_px = DrawPixel(scene.camera2, outlier_rng);
    is_inlier[order[k]] = false;
  }
  outlier_rng.Shuffle(std::span(order));
  Observation observation;
  observation.matches.reserve(n);
  for (const size_t i : order) {
    observation.matches.push_back(matches[i]);
    observation.is_inlier_true.push_back(is_inlier[i]);
  }
  return observation;
}

}  // namespace rcme
