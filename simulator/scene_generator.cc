#include "simulator/scene_generator.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>

#include "parameters/input_error.h"
#include "simulator/baseline_of_parallax.h"
#include "simulator/camera_registry.h"
#include "simulator/motion_registry.h"
#include "simulator/scene_registry.h"
#include "simulator/severity/parallax.h"
#include "simulator/split_by_shares.h"
#include "stats/order_statistic.h"

namespace rcme {
namespace {

// Maximum number of draws per point. Beyond it both images see less than about 1 % of the world, and the
// scene is impossible.
constexpr size_t kMaxDrawsPerPoint = 100;
constexpr size_t kMinDraws = 10'000;

// Number of pilot scenes, and most matches in each, for the baseline of a parallax. The median parallax of a
// scene varies by about 35 % if the translation has any direction: 1000 scenes fix the mean to 1.1 %.
constexpr std::uint32_t kPilotScenes = 1000;
constexpr int kPilotMatches = 100;
// Number of pilot scenes that may be impossible, as a trial may be, before the baseline counts as too long.
constexpr std::uint32_t kMaxRefusedPilots = 20;

using Clearances = std::array<double, PointBlock::kSize>;  // negative if the image does not show the point

// An image shows a point (x, y, z) with z > 0 if |fx x / z + cx - (width - 1) / 2| <= width / 2, and likewise
// for y. Multiplied by 2 z / width: |a| <= c and |b| <= c, where (a, b, c) = clip_from_cam (x, y, z).
Eigen::Matrix3d ClipFromCam(const Camera& camera) {
  Eigen::Matrix3d clip_from_cam = Eigen::Matrix3d::Identity();
  clip_from_cam.row(0) << 2.0 * camera.fx, 0.0, 2.0 * camera.cx - (camera.width - 1);
  clip_from_cam.row(1) << 0.0, 2.0 * camera.fy, 2.0 * camera.cy - (camera.height - 1);
  clip_from_cam.row(0) /= camera.width;
  clip_from_cam.row(1) /= camera.height;
  return clip_from_cam;
}

// Clearance c - max(|a|, |b|) of points in camera 1's frame, (a, b, c) = A point + t.
void MeasureClearance(const Eigen::Matrix3d& A, const Eigen::Vector3d& t, const PointBlock& points,
                      Clearances* clearance) {
  for (size_t i = 0; i < PointBlock::kSize; ++i) {
    const double x = points.x_m[i], y = points.y_m[i], z = points.z_m[i];
    const double a = A(0, 0) * x + A(0, 1) * y + A(0, 2) * z + t.x();
    const double b = A(1, 0) * x + A(1, 1) * y + A(1, 2) * z + t.y();
    const double c = A(2, 0) * x + A(2, 1) * y + A(2, 2) * z + t.z();
    (*clearance)[i] = c - std::max(std::abs(a), std::abs(b));
  }
}

}  // namespace

SceneGenerator::SceneGenerator(const std::string& scene, const std::string& cameras,
                               const std::string& motion)
    : scene_name_(scene) {
  const SceneEntry& entry = FindEntry(SceneRegistry(), "scene", scene);
  cameras_name_ = cameras.empty() ? entry.cameras : cameras;
  motion_name_ = motion.empty() ? entry.motion : motion;
  scene_ = entry.make();
  cameras_ = FindEntry(CameraRegistry(), "cameras", cameras_name_).make();
  motion_ = FindEntry(MotionRegistry(), "motion", motion_name_).make();
  std::vector<std::string> names;
  for (const Parameter& parameter : Parameters()) names.push_back(parameter.name());
  keys_ = fmt::format("{}", fmt::join(names, ", "));
}

std::vector<Parameter> SceneGenerator::Parameters() {
  std::vector<Parameter> all = {
      Parameter::Integer("num_matches", &num_matches_, {1, 1e6}, "matches per pair, outliers included")};
  for (const std::vector<Parameter>& more :
       {scene_->Parameters(), cameras_->Parameters(), motion_->Parameters()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

void SceneGenerator::FixBaseline(const StreamName& pilot) {
  Baseline* baseline = motion_->MutableBaseline();
  if (baseline == nullptr || !baseline->IsParallax()) return;
  const auto parallax_deg = [&](double length_m) -> std::optional<double> {
    baseline->length_of_parallax_m = length_m;
    try {
      return MeanParallaxDeg(pilot);
    } catch (const InputError&) {
      return std::nullopt;  // the images see too little of the scene
    }
  };
  const BaselineSearch found = FindBaseline(parallax_deg, baseline->parallax_deg);
  if (!found.baseline_m) {
    if (found.greatest_deg == 0.0) MeanParallaxDeg(pilot);  // throws, and says why
    throw InputError(fmt::format(
        "parallax_deg: {} is not allowed; scene {} with motion {} and cameras {} gives at most "
        "about {:.2g}, beyond which the views overlap too little; give less, or give baseline_m and set "
        "parallax_deg to none. Settings that matter: {}",
        baseline->parallax_deg, scene_name_, motion_name_, cameras_name_, found.greatest_deg, keys_));
  }
  baseline->length_of_parallax_m = *found.baseline_m;
}

double SceneGenerator::BaselineOfParallax() const {
  const Baseline* baseline = motion_->MutableBaseline();
  return baseline != nullptr && baseline->IsParallax() ? baseline->length_of_parallax_m
                                                       : std::numeric_limits<double>::quiet_NaN();
}

double SceneGenerator::MeanParallaxDeg(const StreamName& pilot) const {
  double sum_deg = 0.0;
  std::uint32_t num_refused = 0;
  for (std::uint32_t trial = 0; trial < kPilotScenes; ++trial) {
    RandomStream rng({pilot.seed, pilot.condition, trial, pilot.purpose});
    try {
      const Scene scene = Generate(std::min(num_matches_, kPilotMatches), rng);
      std::vector<double> angles_deg = ParallaxesDeg(scene, scene.points_in_cam1);
      sum_deg += ComputeQuantile(angles_deg, 0.5);
    } catch (const InputError&) {
      if (++num_refused > kMaxRefusedPilots) throw;
    }
  }
  return sum_deg / (kPilotScenes - num_refused);
}

Scene SceneGenerator::Generate(int num_matches, RandomStream& rng) const {
  return GenerateWith(motion_->Draw(rng), num_matches, rng);
}

Scene SceneGenerator::GenerateWith(const Motion& motion, int num_matches, RandomStream& rng) const {
  Scene scene;
  std::tie(scene.camera1, scene.camera2) = cameras_->Make();
  scene.cam2_from_cam1_true = motion.cam2_from_cam1;
  scene.baseline_m = motion.baseline_m;
  const std::unique_ptr<const World> world = scene_->DrawWorld(scene, rng);
  scene.repeat_steps_m = world->RepeatSteps();
  const std::vector<int> counts = SplitByShares(num_matches, world->PartShares());
  for (size_t part = 0; part < counts.size(); ++part) {
    DrawPart(*world, part, static_cast<size_t>(counts[part]), rng, &scene);
  }
  return scene;
}

void SceneGenerator::DrawPart(const World& world, size_t part, size_t num_points, RandomStream& rng,
                              Scene* scene) const {
  const bool has_lens = scene->camera1.HasLens() || scene->camera2.HasLens();
  const Eigen::Matrix3d clip_from_cam1 = ClipFromCam(scene->camera1),
                        clip_from_cam2 = ClipFromCam(scene->camera2);
  const Eigen::Matrix3d A2 = clip_from_cam2 * scene->cam2_from_cam1_true.R;
  const Eigen::Vector3d t2 = clip_from_cam2 * (scene->baseline_m * scene->cam2_from_cam1_true.t);
  // Without a branch: every candidate is written behind the accepted ones, and stays there if both images see
  // it.
  std::vector<Eigen::Vector3d>& points = scene->points_in_cam1;
  size_t num_accepted = points.size();
  const size_t num_wanted = num_accepted + num_points;
  points.resize(num_wanted + PointBlock::kSize);
  PointBlock candidates;
  Clearances clearance1, clearance2;
  const size_t max_draws = std::max(kMinDraws, kMaxDrawsPerPoint * num_points);
  size_t num_draws = 0;
  for (; num_accepted < num_wanted && num_draws < max_draws; num_draws += PointBlock::kSize) {
    world.DrawCandidates(part, num_draws, rng, &candidates);
    if (!has_lens) {
      MeasureClearance(clip_from_cam1, Eigen::Vector3d::Zero(), candidates, &clearance1);
      MeasureClearance(A2, t2, candidates, &clearance2);
    }
    for (size_t i = 0; i < PointBlock::kSize; ++i) {
      points[num_accepted] = {candidates.x_m[i], candidates.y_m[i], candidates.z_m[i]};
      num_accepted +=
          has_lens ? scene->Sees(points[num_accepted]) : std::min(clearance1[i], clearance2[i]) >= 0.0;
    }
  }
  if (num_accepted < num_wanted) {
    throw InputError(
        fmt::format("{}: both images see only {} of {} points drawn on part {} of the scene, {} are needed; "
                    "make the motion "
                    "smaller or the scene larger. What decides: {}",
                    scene_name_, num_accepted + num_points - num_wanted, num_draws, part, num_points, keys_));
  }
  points.resize(num_wanted);
}

}  // namespace rcme
