#include "simulator/observe.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>

namespace rcme {
namespace {

struct Mismatch {
  std::uint32_t point;  // index in the scene
  Eigen::Vector2d x2_px;
};

Eigen::Vector2d DrawPixel(const Camera& camera, RandomStream& rng) {
  return {rng.Uniform(-0.5, camera.width - 0.5), rng.Uniform(-0.5, camera.height - 0.5)};
}

// Match i of the scene is written to matches[place[i]].
void ProjectWithNoise(const Scene& scene, const NoiseModel& noise, const std::vector<std::uint32_t>& place,
                      RandomStream& rng, std::vector<Correspondence>* matches) {
  constexpr size_t kBlock = 64;
  std::array<double, 4 * kBlock> noise_px;
  const size_t n = place.size();
  for (size_t first = 0; first < n; first += kBlock) {
    const size_t end = std::min(n, first + kBlock);
    noise.Fill(std::span(noise_px).first(4 * (end - first)), rng);
    const double* e = noise_px.data();
    for (size_t i = first; i < end; ++i, e += 4) {
      const Eigen::Vector3d& point = scene.points_in_cam1[i];
      Correspondence& match = (*matches)[place[i]];
      match.x1_px = scene.camera1.Project(point) + Eigen::Vector2d(e[0], e[1]);
      match.x2_px = scene.camera2.Project(scene.InCamera2(point)) + Eigen::Vector2d(e[2], e[3]);
    }
  }
}

}  // namespace

Observation Observe(const Scene& scene, const NoiseModel& noise, const OutlierModel& outliers,
                    RandomStream& noise_rng, RandomStream& outlier_rng) {
  // A random order; the first matches in it become mismatches, then the list is read in a second random
  // order.
  const size_t n = scene.points_in_cam1.size();
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  outlier_rng.Shuffle(std::span(order));
  std::vector<Mismatch> mismatches(static_cast<size_t>(outliers.CountOf(static_cast<int>(n))));
  for (size_t k = 0; k < mismatches.size(); ++k) {
    mismatches[k] = {order[k], DrawPixel(scene.camera2, outlier_rng)};
  }
  outlier_rng.Shuffle(std::span(order));
  std::vector<std::uint32_t> place(n);  // of every point in the list
  for (size_t k = 0; k < n; ++k) place[order[k]] = static_cast<std::uint32_t>(k);

  Observation observation{std::vector<Correspondence>(n), std::vector<bool>(n, true)};
  ProjectWithNoise(scene, noise, place, noise_rng, &observation.matches);
  for (const Mismatch& mismatch : mismatches) {
    observation.matches[place[mismatch.point]].x2_px = mismatch.x2_px;
    observation.is_inlier_true[place[mismatch.point]] = false;
  }
  return observation;
}

}  // namespace rcme
