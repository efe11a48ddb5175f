#include "simulator/scenes/uniform_volume.h"

#include <fmt/format.h>

#include "parameters/input_error.h"

namespace rcme {
namespace {

// Draws per match after which a scene counts as impossible: image 2 sees less than about 1 % of the volume.
constexpr int kMaxDrawsPerMatch = 100;
constexpr int kMinDraws = 10'000;

template <typename T>
void Append(std::vector<T> more, std::vector<T>* all) {
  all->insert(all->end(), more.begin(), more.end());
}

}  // namespace

std::vector<Parameter> UniformVolume::Parameters() {
  std::vector<Parameter> all = {
      Parameter::Integer("num_matches", &num_matches_, {1, 1e6}, "matches per pair, outliers included"),
      Parameter::Real("min_depth_m", &min_depth_m_, {1e-6, 1e9}, "m", "least depth in camera 1"),
      Parameter::Real("max_depth_m", &max_depth_m_, {1e-6, 1e9}, "m", "greatest depth in camera 1")};
  Append(rcme::Parameters(cameras_), &all);
  Append(rcme::Parameters(motion_), &all);
  return all;
}

Scene UniformVolume::Generate(RandomStream& rng) const {
  if (min_depth_m_ > max_depth_m_) {
    throw InputError(fmt::format("min_depth_m: {} is not allowed; give at most max_depth_m = {}",
                                 min_depth_m_, max_depth_m_));
  }
  Scene scene;
  scene.camera1 = scene.camera2 = cameras_.Make();
  scene.cam2_from_cam1_true = motion_.Draw(rng);
  scene.baseline_m = motion_.baseline_m;
  scene.points_in_cam1.reserve(static_cast<size_t>(num_matches_));

  const int max_draws = std::max(kMinDraws, kMaxDrawsPerMatch * num_matches_);
  for (int draw = 0; draw < max_draws; ++draw) {
    const Eigen::Vector2d x1_px(rng.Uniform(-0.5, scene.camera1.width - 0.5),
                                rng.Uniform(-0.5, scene.camera1.height - 0.5));
    const Eigen::Vector3d point = rng.Uniform(min_depth_m_, max_depth_m_) * scene.camera1.Ray(x1_px);
    const Eigen::Vector3d in_cam2 = scene.InCamera2(point);
    if (in_cam2.z() <= 0.0 || !scene.camera2.IsInImage(scene.camera2.Project(in_cam2))) continue;
    scene.points_in_cam1.push_back(point);
    if (static_cast<int>(scene.points_in_cam1.size()) == num_matches_) return scene;
  }
  throw InputError(
      fmt::format("uniform_volume: image 2 sees only {} of {} drawn points; lower max_rotation_deg or "
                  "baseline_m, or raise "
                  "min_depth_m (num_matches = {})",
                  scene.points_in_cam1.size(), max_draws, num_matches_));
}

}  // namespace rcme
