#include "experiments/data/camera_noise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "experiments/core/files/yaml_input.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

constexpr const char *kNoiseVersionKey = "rcme_camera_noise", *kNoiseVersion = "1";
constexpr double kMostPx = 1000.0;
constexpr int kMostCells = 100;  // along a side

const FileKind& NoiseFileKind() {
  static const FileKind kind = {"noise file", "a file of `rcme calibrate-noise`"};
  return kind;
}

struct NoiseRange {
  double least, greatest;
};
constexpr NoiseRange kAnyReal = {-1e12, 1e12}, kAnySize = {0.0, 1e12};

double ReadNoiseReal(const Place& place, const YAML::Node& node, const std::string& key, NoiseRange allowed) {
  const std::string text = Line(place, node, key);
  double value = 0.0;
  if (ParseReal(text, &value) && value >= allowed.least && value <= allowed.greatest) return value;
  place.Fail(node, fmt::format("{}: {} is not allowed; give a number in [{:g}, {:g}]", key, Quoted(text),
                               allowed.least, allowed.greatest));
}

std::vector<double> ReadNoiseReals(const Place& place, const YAML::Node& node, const std::string& key,
                                   size_t size, NoiseRange allowed) {
  if (!node.IsSequence() || node.size() != size)
    place.Fail(node, fmt::format("{}: a list of {} numbers is needed", key, size));
  std::vector<double> values;
  for (const YAML::Node& value : node) values.push_back(ReadNoiseReal(place, value, key, allowed));
  return values;
}

// Reads a map in which each of these keys stands once, but for those that may be missing.
using NoiseReaders = std::map<std::string, std::function<void(const YAML::Node&)>>;
void ReadNoiseMap(const Place& place, const YAML::Node& node, const std::string& name,
                  const NoiseReaders& readers, const std::set<std::string>& optional = {}) {
  std::set<std::string> known, missing;
  for (const auto& [key, read] : readers) {
    known.insert(key);
    if (!optional.contains(key)) missing.insert(key);
  }
  for (const auto& [key, value] : Entries(place, node, name, known)) {
    readers.at(key)(value);
    missing.erase(key);
  }
  if (!missing.empty()) place.Fail(node, fmt::format("{}: key '{}' is missing", name, *missing.begin()));
}

std::function<void(const YAML::Node&)> RealReader(const Place& place, const std::string& key,
                                                  NoiseRange allowed, double* value) {
  return [=, &place](const YAML::Node& node) { *value = ReadNoiseReal(place, node, key, allowed); };
}

Measured ReadMeasured(const Place& place, const YAML::Node& node, const std::string& key,
                      NoiseRange allowed) {
  Measured measured;
  ReadNoiseMap(place, node, key,
               {{"value", RealReader(place, key, allowed, &measured.value)},
                {"standard_error", RealReader(place, key, kAnySize, &measured.standard_error)}});
  return measured;
}

void ReadEvidence(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  double pairs = 0.0, matches = 0.0;
  ReadNoiseMap(
      place, node, "rests_on",
      {{"pairs", RealReader(place, "pairs", {1, 1e9}, &pairs)},
       {"matches", RealReader(place, "matches", {1, 1e15}, &matches)},
       {"effective_pairs", RealReader(place, "effective_pairs", kAnySize, &noise->effective_pairs)},
       {"estimator", [&](const YAML::Node& text) { noise->estimator = Name(place, text, "estimator"); }}});
  noise->num_pairs = static_cast<int>(pairs);
  noise->num_matches = static_cast<std::int64_t>(matches);
}

void ReadNoiseCamera(const Place& place, const YAML::Node& node, Camera* camera) {
  double width = 0.0, height = 0.0;
  const auto real = [&](const char* key, NoiseRange allowed, double* value) {
    return RealReader(place, key, allowed, value);
  };
  ReadNoiseMap(place, node, "camera",
               {{"width", real("width", {1, 1e6}, &width)},
                {"height", real("height", {1, 1e6}, &height)},
                {"fx", real("fx", {1e-3, 1e9}, &camera->fx)},
                {"fy", real("fy", {1e-3, 1e9}, &camera->fy)},
                {"cx", real("cx", kAnyReal, &camera->cx)},
                {"cy", real("cy", kAnyReal, &camera->cy)}});
  camera->width = static_cast<int>(width);
  camera->height = static_cast<int>(height);
}

void ReadDisplacement(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  ReadNoiseMap(place, node, "displacement_field",
               {{"sd_px", RealReader(place, "sd_px", {1e-9, kMostPx}, &noise->displacement_px.value)},
                {"standard_error",
                 RealReader(place, "standard_error", kAnySize, &noise->displacement_px.standard_error)},
                {"reach_px", RealReader(place, "reach_px", {0.1, 1e5}, &noise->reach_px)},
                {"reach_factor", RealReader(place, "reach_factor", {1.0, 1e12}, &noise->reach_factor)}});
}

CameraCorrection ReadCorrection(const Place& place, const YAML::Node& node, size_t fault) {
  CameraCorrection correction{fault, {}, {0.0, 0.0}};
  const std::string name = kCorrectableFaults[fault];
  ReadNoiseMap(
      place, node, name,
      {{"value", RealReader(place, name, kAnyReal, &correction.estimate.value)},
       {"standard_error", RealReader(place, name, kAnySize, &correction.estimate.standard_error)},
       {"removed", RealReader(place, name, {-1e4, 1e4}, &correction.removed.value)},
       {"removed_standard_error", RealReader(place, name, kAnySize, &correction.removed.standard_error)}},
      {"removed", "removed_standard_error"});
  return correction;
}

void ReadCorrections(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  NoiseReaders readers;
  std::set<std::string> optional;
  for (size_t fault = 0; fault < kCorrectableFaults.size(); ++fault) {
    optional.insert(kCorrectableFaults[fault]);
    readers[kCorrectableFaults[fault]] = [&place, noise, fault](const YAML::Node& value) {
      noise->corrections.push_back(ReadCorrection(place, value, fault));
    };
  }
  ReadNoiseMap(place, node, "camera_faults", readers, optional);
}

void ReadSystematic(const Place& place, const YAML::Node& node, DisplacementCells* cells) {
  double columns = 0.0, rows = 0.0;
  YAML::Node dx, dy;
  ReadNoiseMap(place, node, "systematic_displacement",
               {{"columns", RealReader(place, "columns", {1, kMostCells}, &columns)},
                {"rows", RealReader(place, "rows", {1, kMostCells}, &rows)},
                {"rms_px", RealReader(place, "rms_px", {0.0, kMostPx}, &cells->rms_px)},
                {"p_value", RealReader(place, "p_value", {0.0, 1.0}, &cells->p_value)},
                {"dx_px", [&](const YAML::Node& list) { dx.reset(list); }},
                {"dy_px", [&](const YAML::Node& list) { dy.reset(list); }}});
  cells->columns = static_cast<int>(columns);
  cells->rows = static_cast<int>(rows);
  const auto size = static_cast<size_t>(cells->columns) * static_cast<size_t>(cells->rows);
  cells->dx_px = ReadNoiseReals(place, dx, "dx_px", size, {-kMostPx, kMostPx});
  cells->dy_px = ReadNoiseReals(place, dy, "dy_px", size, {-kMostPx, kMostPx});
}

void WriteNoiseMap(YAML::Emitter* out, const char* name,
                   const std::vector<std::pair<const char*, double>>& values) {
  *out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginMap;
  for (const auto& [key, value] : values)
    *out << YAML::Key << key << YAML::Value << fmt::format("{:.8g}", value);
  *out << YAML::EndMap;
}

void WriteNoiseList(YAML::Emitter* out, const char* name, const std::vector<double>& values) {
  *out << YAML::Key << name << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double value : values) *out << fmt::format("{:.6g}", value);
  *out << YAML::EndSeq;
}

std::string LastNoiseValue(const Settings& settings, const std::string& key) {
  std::string last;
  for (const auto& [name, value] : settings) {
    if (name == key) last = value;
  }
  return last;
}

}  // namespace

double CameraNoise::DisplacementShare() const {
  const double share = displacement_px.value / sigma_px.value;
  return std::min(1.0, share * share);
}

std::string CameraNoiseAsYaml(const CameraNoise& noise) {
  YAML::Emitter out;
  out << YAML::BeginMap << YAML::Key << kNoiseVersionKey << YAML::Value << kNoiseVersion;
  out << YAML::Key << "rests_on" << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "pairs" << YAML::Value << noise.num_pairs;
  out << YAML::Key << "matches" << YAML::Value << noise.num_matches;
  out << YAML::Key << "effective_pairs" << YAML::Value << fmt::format("{:.4g}", noise.effective_pairs);
  out << YAML::Key << "estimator" << YAML::Value << noise.estimator << YAML::EndMap;
  const Camera& camera = noise.camera;
  WriteNoiseMap(&out, "camera",
                {{"width", camera.width},
                 {"height", camera.height},
                 {"fx", camera.fx},
                 {"fy", camera.fy},
                 {"cx", camera.cx},
                 {"cy", camera.cy}});
  WriteNoiseMap(&out, "sigma_px",
                {{"value", noise.sigma_px.value}, {"standard_error", noise.sigma_px.standard_error}});
  if (std::isfinite(noise.size_exponent.value)) {
    WriteNoiseMap(
        &out, "size_exponent",
        {{"value", noise.size_exponent.value}, {"standard_error", noise.size_exponent.standard_error}});
  }
  out << YAML::Key << "key_point_px" << YAML::Value << fmt::format("{:.6g}", noise.key_point_px);
  if (noise.displacement_px.value > 0.0) {
    WriteNoiseMap(&out, "displacement_field",
                  {{"sd_px", noise.displacement_px.value},
                   {"standard_error", noise.displacement_px.standard_error},
                   {"reach_px", noise.reach_px},
                   {"reach_factor", noise.reach_factor}});
  }
  if (!noise.corrections.empty()) {
    out << YAML::Key << "camera_faults" << YAML::Value << YAML::BeginMap;
    for (const CameraCorrection& each : noise.corrections) {
      std::vector<std::pair<const char*, double>> values = {{"value", each.estimate.value},
                                                            {"standard_error", each.estimate.standard_error}};
      if (each.removed.value != 0.0) {
        values.emplace_back("removed", each.removed.value);
        values.emplace_back("removed_standard_error", each.removed.standard_error);
      }
      WriteNoiseMap(&out, kCorrectableFaults[each.fault], values);
    }
    out << YAML::EndMap;
    WriteNoiseList(&out, "correlations", noise.correlations);
    if (!noise.removed_correlations.empty())
      WriteNoiseList(&out, "removed_correlations", noise.removed_correlations);
    if (std::isfinite(noise.seconds_between))
      out << YAML::Key << "seconds_between" << YAML::Value << fmt::format("{:.6g}", noise.seconds_between);
  }
  if (noise.systematic.columns > 0) {
    const DisplacementCells& cells = noise.systematic;
    out << YAML::Key << "systematic_displacement" << YAML::Value << YAML::BeginMap;
    out << YAML::Key << "columns" << YAML::Value << cells.columns;
    out << YAML::Key << "rows" << YAML::Value << cells.rows;
    out << YAML::Key << "rms_px" << YAML::Value << fmt::format("{:.6g}", cells.rms_px);
    out << YAML::Key << "p_value" << YAML::Value << fmt::format("{:.4g}", cells.p_value);
    WriteNoiseList(&out, "dx_px", cells.dx_px);
    WriteNoiseList(&out, "dy_px", cells.dy_px);
    out << YAML::EndMap;
  }
  out << YAML::EndMap;
  return "# How to use it: `rcme estimate MATCHES --noise FILE`; in a study `data: {noise: from_file, "
         "noise_file: "
         "FILE}`\n# Lengths in px; focal_length and readout_time are shares (0.01 is 1 %).\n" +
         std::string(out.c_str()) + "\n";
}

CameraNoise ReadCameraNoise(const std::string& path) {
  return ParseCameraNoise(ReadInputText(path, NoiseFileKind()), path);
}

CameraNoise ParseCameraNoise(const std::string& yaml, const std::string& path) {
  const Place place(path);
  const YAML::Node root = ParseYaml(yaml, path, NoiseFileKind());
  if (!root.IsMap() || !root[kNoiseVersionKey])
    throw InputError(
        fmt::format("{}: it is no noise file: key '{}' is missing; `rcme calibrate-noise PAIRS "
                    "--out FILE` writes one",
                    path, kNoiseVersionKey));
  CameraNoise noise;
  const auto measured = [&](const char* key, NoiseRange allowed, Measured* value) {
    return [&place, key, allowed, value](const YAML::Node& node) {
      *value = ReadMeasured(place, node, key, allowed);
    };
  };
  YAML::Node correlations, removed_correlations;
  ReadNoiseMap(
      place, root, "noise file",
      {{kNoiseVersionKey,
        [&](const YAML::Node& node) {
          if (Line(place, node, kNoiseVersionKey) != kNoiseVersion)
            place.Fail(node,
                       fmt::format("{}: this program reads version {}", kNoiseVersionKey, kNoiseVersion));
        }},
       {"rests_on", [&](const YAML::Node& node) { ReadEvidence(place, node, &noise); }},
       {"camera", [&](const YAML::Node& node) { ReadNoiseCamera(place, node, &noise.camera); }},
       {"sigma_px", measured("sigma_px", {1e-9, kMostPx}, &noise.sigma_px)},
       {"size_exponent", measured("size_exponent", {-10.0, 10.0}, &noise.size_exponent)},
       {"key_point_px", RealReader(place, "key_point_px", {0.0, kMostPx}, &noise.key_point_px)},
       {"displacement_field", [&](const YAML::Node& node) { ReadDisplacement(place, node, &noise); }},
       {"camera_faults", [&](const YAML::Node& node) { ReadCorrections(place, node, &noise); }},
       {"correlations", [&](const YAML::Node& node) { correlations.reset(node); }},
       {"removed_correlations", [&](const YAML::Node& node) { removed_correlations.reset(node); }},
       {"seconds_between", RealReader(place, "seconds_between", {1e-9, 1e9}, &noise.seconds_between)},
       {"systematic_displacement",
        [&](const YAML::Node& node) { ReadSystematic(place, node, &noise.systematic); }}},
      {"size_exponent", "displacement_field", "camera_faults", "correlations", "removed_correlations",
       "seconds_between", "systematic_displacement"});
  const size_t num_faults = noise.corrections.size(),
               num_removed = static_cast<size_t>(std::ranges::count_if(
                   noise.corrections, [](const CameraCorrection&each) { return each.removed.value != 0.0; }));
  if (root["correlations"])
    noise.correlations =
        ReadNoiseReals(place, correlations, "correlations", num_faults * num_faults, {-1.0001, 1.0001});
  if (num_removed > 0 && !root["removed_correlations"])
    place.Fail(root, "noise file: key 'removed_correlations' is missing");
  if (root["removed_correlations"])
    noise.removed_correlations = ReadNoiseReals(place, removed_correlations, "removed_correlations",
                                                num_removed * num_removed, {-1.0001, 1.0001});
  if (std::hypot(noise.key_point_px, noise.displacement_px.value) > 1.0001 * noise.sigma_px.value)
    place.Fail(root, "sigma_px: key_point_px and displacement_field have more variance than all of it");
  return noise;
}

Settings WithNoiseFile(const Settings& settings) {
  if (LastNoiseValue(settings, "noise") != kNoiseFromFile) return settings;
  const std::string path = LastNoiseValue(settings, kNoiseFileKey);
  if (path.empty())
    throw InputError(fmt::format("noise: {} needs the key '{}': {}", kNoiseFromFile, kNoiseFileKey,
                                 NoiseFileKind().article_name));
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
