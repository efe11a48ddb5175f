#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "simulator/exact_match.h"
#include "simulator/outlier_law.h"
#include "simulator/scene_generator.h"

namespace rcme {

using Settings = std::vector<std::pair<std::string, std::string>>;

inline std::unique_ptr<OutlierLaw> WithSettings(std::unique_ptr<OutlierLaw> law, const Settings& settings) {
  for (const auto& [key, value] : settings) FindParameter(law->Parameters(), key).SetFromText(value);
  return law;
}

// Two different cameras, any motion of up to 10 deg. Not a scene that repeats itself; but so that every law
// has what it needs, it says it does.
inline Scene SceneForOutliers(int num_matches, std::uint32_t trial = 0, const std::string& motion = "general",
                              const Settings& settings = {}) {
  SceneGenerator generator("uniform_volume", "two_pinholes", motion);
  FindParameter(generator.Parameters(), "num_matches").SetFromText(std::to_string(num_matches));
  for (const auto& [key, value] : settings) FindParameter(generator.Parameters(), key).SetFromText(value);
  generator.FixBaseline({.purpose = 81});
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 80});
  Scene scene = generator.Generate(rng);
  scene.repeat_steps_m = {{0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}};
  return scene;
}

// The matches of a scene, in the order of its points, of which the first ones have become wrong.
struct DrawnOutliers {
  std::vector<Correspondence> exact, noisy, matches;  // noisy: before they became wrong
  std::vector<std::uint32_t> points;                  // 0, 1, ...; first the wrong ones
  std::vector<bool> is_undetectable;
};

// Match i shows the scene's point `shown`[i]; empty: i.
inline DrawnOutliers MakeWrong(const OutlierLaw& law, const Scene& scene, size_t num_wrong,
                               double noise_px = 0.0, std::uint32_t trial = 0,
                               const CameraDefects& defects = {}, std::vector<std::uint32_t> shown = {}) {
  const size_t n = scene.points_in_cam1.size();
  RandomStream noise_rng({.seed = 1, .trial = trial, .purpose = 81});
  RandomStream rng({.seed = 1, .trial = trial, .purpose = 82});
  if (shown.empty()) {
    shown.resize(n);
    std::iota(shown.begin(), shown.end(), 0u);
  }
  DrawnOutliers wrong;
  for (const std::uint32_t point : shown) {
    wrong.exact.push_back(ImagedMatch(scene, defects, scene.points_in_cam1[point]));
    wrong.noisy.push_back(wrong.exact.back());
    for (Eigen::Vector2d* x_px : {&wrong.noisy.back().x1_px, &wrong.noisy.back().x2_px}) {
      for (const int axis : {0, 1}) (*x_px)(axis) += noise_px * noise_rng.Normal();
    }
  }
  wrong.matches = wrong.noisy;
  wrong.is_undetectable.resize(n);
  wrong.points.resize(n);
  std::iota(wrong.points.begin(), wrong.points.end(), 0u);
  const std::span<const std::uint32_t> all(wrong.points);
  law.Replace(
      all.first(num_wrong),
      {scene, defects, shown, all.subspan(num_wrong), wrong.matches, wrong.is_undetectable, wrong.exact},
      rng);
  return wrong;
}

inline bool AreEqual(const Correspondence& a, const Correspondence& b) {
  return a.x1_px == b.x1_px && a.x2_px == b.x2_px;
}

// How far the rays of a match are from coplanar with the baseline: the scalar triple product of the two rays
// and the direction of motion. Written out, not with E.
inline double TripleProduct(const Scene& scene, const Correspondence& match) {
  const Eigen::Vector3d ray1_in_cam2 = scene.cam2_from_cam1_true.R * scene.camera1.Ray(match.x1_px);
  return scene.camera2.Ray(match.x2_px).dot(scene.cam2_from_cam1_true.t.cross(ray1_in_cam2));
}

}  // namespace rcme
