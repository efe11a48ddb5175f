#include "simulator/scenes/uniform_volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "parameters/input_error.h"

namespace rcme {
namespace {

// Draws per match, rounded up to blocks, after which a scene counts as impossible: image 2 sees less than
// about 1 % of the volume.
constexpr int kMaxDrawsPerMatch = 100;
constexpr int kMinDraws = 10'000;

// Candidates are drawn and judged in blocks: plain loops over arrays, which the compiler turns into vectors.
constexpr int kBlock = 128;

struct Candidates {
  std::array<double, kBlock> x_m, y_m, z_m;  // points in camera 1
  std::array<double, kBlock> clearance;      // negative if image 2 does not see the point
};

// Three uniforms a point: its y in image 1, x in image 1, depth.
void PlacePoints(const std::array<double, 3 * kBlock>& uniforms, const Camera& camera, double min_depth_m,
                 double max_depth_m, Candidates* candidates) {
  const double width_px = camera.width, height_px = camera.height;
  const double depth_span_m = max_depth_m - min_depth_m;
  for (size_t i = 0; i < kBlock; ++i) {
    const double depth_m = min_depth_m + depth_span_m * uniforms[3 * i + 2];
    candidates->x_m[i] = depth_m * ((-0.5 + width_px * uniforms[3 * i + 1] - camera.cx) / camera.fx);
    candidates->y_m[i] = depth_m * ((-0.5 + height_px * uniforms[3 * i] - camera.cy) / camera.fy);
    candidates->z_m[i] = depth_m;
  }
}

// Image 2 sees a point (x, y, z) with z > 0 if |fx x / z + cx - (width - 1) / 2| <= width / 2, y likewise.
// Times 2 z / width: |a| <= c and |b| <= c, where (a, b, c) = clip_from_cam2 (x, y, z) = A point_in_cam1 + t.
void MeasureClearance(const Scene& scene, Candidates* candidates) {
  const Camera& camera = scene.camera2;
  Eigen::Matrix3d clip_from_cam2 = Eigen::Matrix3d::Identity();
  clip_from_cam2.row(0) << 2.0 * camera.fx, 0.0, 2.0 * camera.cx - (camera.width - 1);
  clip_from_cam2.row(1) << 0.0, 2.0 * camera.fy, 2.0 * camera.cy - (camera.height - 1);
  clip_from_cam2.row(0) /= camera.width;
  clip_from_cam2.row(1) /= camera.height;
  const Eigen::Matrix3d A = clip_from_cam2 * scene.cam2_from_cam1_true.R;
  const Eigen::Vector3d t = clip_from_cam2 * (scene.baseline_m * scene.cam2_from_cam1_true.t);
  for (size_t i = 0; i < kBlock; ++i) {
    const double x = candidates->x_m[i], y = candidates->y_m[i], z = candidates->z_m[i];
    const double a = A(0, 0) * x + A(0, 1) * y + A(0, 2) * z + t.x();
    const double b = A(1, 0) * x + A(1, 1) * y + A(1, 2) * z + t.y();
    const double c = A(2, 0) * x + A(2, 1) * y + A(2, 2) * z + t.z();
    candidates->clearance[i] = c - std::max(std::abs(a), std::abs(b));
  }
}

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

  // Every candidate is written behind the accepted ones, and stays there if image 2 sees it: no branch.
  const size_t num_matches = static_cast<size_t>(num_matches_);
  scene.points_in_cam1.resize(num_matches + kBlock);
  size_t num_accepted = 0;
  std::array<double, 3 * kBlock> uniforms;
  Candidates candidates;
  const int max_draws = std::max(kMinDraws, kMaxDrawsPerMatch * num_matches_);
  int num_draws = 0;
  for (; num_draws < max_draws; num_draws += kBlock) {
    rng.FillUniform(uniforms);
    PlacePoints(uniforms, scene.camera1, min_depth_m_, max_depth_m_, &candidates);
    MeasureClearance(scene, &candidates);
    for (size_t i = 0; i < kBlock; ++i) {
      scene.points_in_cam1[num_accepted] = {candidates.x_m[i], candidates.y_m[i], candidates.z_m[i]};
      num_accepted += candidates.clearance[i] >= 0.0;
    }
    if (num_accepted < num_matches) continue;
    scene.points_in_cam1.resize(num_matches);
    return scene;
  }
  throw InputError(
      fmt::format("uniform_volume: image 2 sees only {} of {} drawn points; lower max_rotation_deg or "
                  "baseline_m, or raise "
                  "min_depth_m (num_matches = {})",
                  num_accepted, num_draws, num_matches_));
}

}  // namespace rcme
