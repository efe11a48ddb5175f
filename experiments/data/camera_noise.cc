#include "experiments/data/camera_noise.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>

#include "parameters/input_error.h"
#include "parameters/settings.h"

namespace rcme {
namespace {

void WriteNoiseMap(const char* name, const std::vector<std::pair<const char*, double>>& values,
                   YAML::Emitter* out) {
  *out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (const auto& [key, value] : values)
    *out << YAML::Key << key << YAML::Value << fmt::format("{:.8g}", value);
  *out << YAML::EndMap;
}

void WriteNoiseList(const char* name, const std::vector<double>& values, YAML::Emitter* out) {
  *out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double value : values) *out << fmt::format("{:.6g}", value);
  *out << YAML::EndSeq;
}

void WriteEvidence(const CameraNoise& noise, YAML::Emitter* out) {
  *out << YAML::Key << "rests_on" << YAML::Value << YAML::BeginMap;
  *out << YAML::Key << "pairs" << YAML::Value << noise.num_pairs;
  *out << YAML::Key << "matches" << YAML::Value << noise.num_matches;
  *out << YAML::Key << "effective_pairs" << YAML::Value << fmt::format("{:.4g}", noise.effective_pairs);
  *out << YAML::Key << "estimator" << YAML::Value << noise.estimator << YAML::EndMap;
  const Camera& camera = noise.camera;
  WriteNoiseMap("camera",
                {{"width", camera.width},
                 {"height", camera.height},
                 {"fx", camera.fx},
                 {"fy", camera.fy},
                 {"cx", camera.cx},
                 {"cy", camera.cy}},
                out);
}

void WriteSigma(const CameraNoise& noise, YAML::Emitter* out) {
  const auto write = [&](const char* name, const ValueWithError& measured) {
    WriteNoiseMap(name, {{"value", measured.value}, {"standard_error", measured.standard_error}}, out);
  };
  write("sigma_px", noise.sigma_px);
  if (std::isfinite(noise.size_exponent.value)) write("size_exponent", noise.size_exponent);
  *out << YAML::Key << "key_point_px" << YAML::Value << fmt::format("{:.6g}", noise.key_point_px);
  if (noise.displacement_px.value > 0.0) {
    WriteNoiseMap("displacement_field",
                  {{"sd_px", noise.displacement_px.value},
                   {"standard_error", noise.displacement_px.standard_error},
                   {"reach_px", noise.reach_px},
                   {"reach_factor", noise.reach_factor}},
                  out);
  }
  if (noise.unseen_px > 0.0)
    WriteNoiseMap("unseen_field", {{"sd_px", noise.unseen_px}, {"reach_px", noise.unseen_reach_px}}, out);
}

void WriteFaults(const CameraNoise& noise, YAML::Emitter* out) {
  if (noise.corrections.empty()) return;
  *out << YAML::Key << "camera_faults" << YAML::Value << YAML::BeginMap;
  for (const CameraCorrection& each : noise.corrections) {
    std::vector<std::pair<const char*, double>> values = {{"value", each.estimate.value},
                                                          {"standard_error", each.estimate.standard_error}};
    if (each.removed != 0.0) values.emplace_back("removed", each.removed);
    values.emplace_back("uncertainty", each.uncertainty);
    WriteNoiseMap(kCorrectableFaults[each.fault], values, out);
  }
  *out << YAML::EndMap;
  WriteNoiseList("correlations", noise.correlations, out);
  WriteNoiseList("uncertainty_correlations", noise.uncertainty_correlations, out);
  if (std::isfinite(noise.seconds_between))
    *out << YAML::Key << "seconds_between" << YAML::Value << fmt::format("{:.6g}", noise.seconds_between);
}

void WriteSystematic(const DisplacementCells& cells, YAML::Emitter* out) {
  if (cells.columns == 0) return;
  *out << YAML::Key << "systematic_displacement" << YAML::Value << YAML::BeginMap;
  *out << YAML::Key << "columns" << YAML::Value << cells.columns;
  *out << YAML::Key << "rows" << YAML::Value << cells.rows;
  *out << YAML::Key << "rms_px" << YAML::Value << fmt::format("{:.6g}", cells.rms_px);
  *out << YAML::Key << "p_value" << YAML::Value << fmt::format("{:.4g}", cells.p_value);
  WriteNoiseList("dx_px", cells.dx_px, out);
  WriteNoiseList("dy_px", cells.dy_px, out);
  *out << YAML::EndMap;
}

}  // namespace

double CameraNoise::DisplacementShare() const {
  const double share = displacement_px.value / sigma_px.value;
  return std::min(1.0, share * share);
}

std::string CameraNoiseAsYaml(const CameraNoise& noise) {
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << kNoiseVersionKey << YAML::Value << kNoiseVersion;
  WriteEvidence(noise, &out);
  WriteSigma(noise, &out);
  WriteFaults(noise, &out);
  WriteSystematic(noise.systematic, &out);
  out << YAML::EndMap;
  return "# How to use it: `rcme estimate MATCHES --noise FILE`; in a study `data: {noise: from_file, "
         "noise_file: "
         "FILE}`\n# Lengths in px; focal_length and readout_time are shares (0.01 is 1 %).\n" +
         std::string(out.c_str()) + "\n";
}

Settings WithNoiseFile(const Settings& settings) {
  if (FindSetting(settings, "noise") != kNoiseFromFile) return settings;
  const std::string path = FindSetting(settings, kNoiseFileKey).value_or("");
  if (path.empty())
    throw InputError(fmt::format("noise: {} needs the key '{}': a file of `rcme calibrate-noise`",
                                 kNoiseFromFile, kNoiseFileKey));
  const CameraNoise noise = ReadCameraNoise(path);
  Settings expanded = {{"noise", "displacement_field"},
                       {"sigma_px", fmt::format("{}", noise.sigma_px.value)},
                       {"displacement_share", fmt::format("{}", noise.DisplacementShare())}};
  if (noise.reach_px > 0.0) expanded.emplace_back("displacement_reach_px", fmt::format("{}", noise.reach_px));
  std::ranges::copy_if(settings, std::back_inserter(expanded), [](const auto& setting) {
    return setting.first != "noise" && setting.first != kNoiseFileKey;
  });
  return expanded;
}

}  // namespace rcme
