#include "experiments/real/truth_free/twin_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "experiments/data/make_data.h"
#include "stats/median_ratio.h"
#include "stats/spatial_pattern.h"

namespace rcme {
namespace {

void Set(Settings* settings, const std::string& key, const std::string& value) {
  settings->emplace_back(key, value);
}
void Set(Settings* settings, const std::string& key, double value) {
  Set(settings, key, fmt::format("{:.4g}", value));
}

void SetCameras(const TwinFit& fit, Settings* data) {
  Set(data, "cameras", "own_intrinsics");
  int number = 1;
  for (const Camera& camera : {fit.camera1, fit.camera2}) {
    Set(data, fmt::format("image{}_width", number), fmt::format("{}", camera.width));
    Set(data, fmt::format("image{}_height", number), fmt::format("{}", camera.height));
    for (const auto& [key, value] : {std::pair{"fx{}_px", camera.fx},
                                     {"fy{}_px", camera.fy},
                                     {"cx{}_px", camera.cx},
                                     {"cy{}_px", camera.cy}})
      Set(data, fmt::format(fmt::runtime(key), number), fmt::format("{}", value));
    ++number;
  }
}

void SetMotion(const TwinFit& fit, Settings* data) {
  const bool turns_about_scene = fit.forwardness < 0.5 && fit.rotation_deg > 0.5 * fit.parallax_deg;
  if (turns_about_scene) {
    Set(data, "motion", "orbit");
    Set(data, "orbit_deg", fit.rotation_deg);
  } else {
    Set(data, "motion", fit.forwardness > 0.9 ? "forward" : fit.forwardness < 0.35 ? "sideways" : "general");
    Set(data, "max_rotation_deg", 2.0 * fit.rotation_deg);  // uniform from 0: its median is half of that
  }
  Set(data, "parallax_deg", fit.parallax_deg);
}

void SetNoise(const RedrawSettings& noise, double assumed_sigma_px, Settings* data) {
  Set(data, "noise", "correlated");
  Set(data, "noise_correlation", noise.far_share);
  Set(data, "noise_correlation_length_px", noise.far_length_px);
  Set(data, "noise_student_dof", noise.student_dof);
  Set(data, "sigma_px", noise.noise_px);
  Set(data, "assumed_sigma_px", assumed_sigma_px);
}

void SetScene(const TwinFit& fit, double clustered_share, Settings* data) {
  const double farthest = std::max(fit.farthest, 1.05 * fit.nearest);
  if (fit.homography_share > 0.8) {
    Set(data, "scene", "plane_and_parallax");
    Set(data, "plane_depth_m", 0.5 * (fit.nearest + farthest));
    Set(data, "off_plane_share", 1.0 - fit.homography_share);
    Set(data, "off_plane_m", 0.5 * (farthest - fit.nearest));
  } else {
    Set(data, "scene", "image_clusters");
    Set(data, "min_depth_m", fit.nearest);
    Set(data, "max_depth_m", farthest);
    Set(data, "num_clusters", "20");
    Set(data, "cluster_spread_px", 0.03 * fit.camera1.width);
    Set(data, "clustered_share", clustered_share);
  }
}

double ComputeClarkEvans(const Settings& settings) {
  const std::shared_ptr<const SimulatedData> data = MakeSimulatedData(settings);
  std::vector<double> indices;
  for (std::uint32_t scene_number = 0; scene_number < 7; ++scene_number) {
    const Scene scene = data->DrawScene({1, 0, scene_number, 0});
    std::vector<Eigen::Vector2d> key_points;
    for (const Eigen::Vector3d& point : scene.points_in_cam1)
      key_points.push_back(scene.camera1.Project(point));
    indices.push_back(ClarkEvansIndex(key_points, scene.camera1.width, scene.camera1.height));
  }
  return ComputeMedian(std::move(indices));
}

}  // namespace

Settings SemiRealData(const TwinFit& fit, const std::string& folder, double assumed_sigma_px) {
  Settings data = {{"scene", kMatchFilesScene}, {"folder", folder}};
  Set(&data, "sigma_px", assumed_sigma_px);
  RedrawSettings noise = fit.noise;
  for (const Parameter& parameter : Parameters(noise)) Set(&data, parameter.name(), parameter.Value());
  return data;
}

double FitClusteredShare(const TwinFit& fit) {
  double least = std::numeric_limits<double>::infinity(), best = 0.0;
  for (const double share : {0.0, 0.3, 0.6, 0.9}) {
    const Settings data = SimulatedTwinData(fit, share, 1.0);
    if (data.front().second != "image_clusters") return 0.0;
    const double difference = std::abs(ComputeClarkEvans(data) - fit.clark_evans);
    if (difference >= least) continue;
    least = difference;
    best = share;
  }
  return best;
}

Settings SimulatedTwinData(const TwinFit& fit, double clustered_share, double assumed_sigma_px) {
  Settings data;
  SetScene(fit, clustered_share, &data);
  SetCameras(fit, &data);
  SetMotion(fit, &data);
  SetNoise(fit.simulated_noise, assumed_sigma_px, &data);
  Set(&data, "num_matches", fmt::format("{}", fit.num_matches));
  Set(&data, "outlier_ratio", fit.wrong_share);
  Set(&data, "outliers", fit.wrong_agreeing_share > 0.3 ? "clustered_both" : "uniform");
  Set(&data, "severity", "skipped");
  return data;
}

}  // namespace rcme
