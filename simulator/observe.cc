#include "simulator/observe.h"

#include <cstdint>
#include <numeric>
#include <span>

namespace rcme {
namespace {

std::vector<Correspondence> ExactMatches(const Scene& scene, std::span<const std::uint32_t> points,
                                         const CameraDefects& defects) {
  std::vector<Correspondence> matches;
  matches.reserve(points.size());
  for (const std::uint32_t point : points) {
    matches.push_back(ImagedMatch(scene, defects, scene.points_in_cam1[point]));
  }
  return matches;
}

}  // namespace

Observation Observe(const Scene& scene, const NoiseModel& noise, const OutlierModel& outliers,
                    RandomStream& noise_rng, RandomStream& outlier_rng, const CameraDefects& defects) {
  CheckDistortion(scene, defects);
  const size_t n = scene.points_in_cam1.size();
  std::vector<std::uint32_t> points(n);
  std::iota(points.begin(), points.end(), 0u);
  noise.DrawPoints(points, noise_rng);
  const std::vector<Correspondence> exact = ExactMatches(scene, points, defects);
  std::vector<Correspondence> matches = exact;
  const std::vector<double> noise_scale = noise.AddAndTell(matches, noise_rng);

  // In a random order the first matches become wrong; then the list is shuffled again.
  const OutlierModel::Drawn drawn = outliers.DrawCount(static_cast<int>(n), outlier_rng);
  const auto num_outliers = static_cast<size_t>(drawn.num_outliers);
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  outlier_rng.Shuffle(std::span(order));
  std::vector<bool> is_inlier(n, true), is_undetectable(n, false);
  for (size_t k = 0; k < num_outliers; ++k) is_inlier[order[k]] = false;
  const std::span<const std::uint32_t> all(order);
  outliers.law->Replace(all.first(num_outliers),
                        {scene, defects, points, all.subspan(num_outliers), matches, is_undetectable, exact},
                        outlier_rng);
  outlier_rng.Shuffle(std::span(order));

  Observation observation{std::vector<Correspondence>(n), {}, std::vector<bool>(n),
                          std::vector<bool>(n),           {}, drawn.weight};
  observation.point.reserve(n);
  observation.noise_scale.reserve(noise_scale.size());
  for (size_t k = 0; k < n; ++k) {
    observation.matches[k] = matches[order[k]];
    observation.is_inlier_true[k] = is_inlier[order[k]];
    observation.is_undetectable[k] = is_undetectable[order[k]];
    observation.point.push_back(points[order[k]]);
    if (!noise_scale.empty()) observation.noise_scale.push_back(noise_scale[order[k]]);
  }
  return observation;
}

}  // namespace rcme
