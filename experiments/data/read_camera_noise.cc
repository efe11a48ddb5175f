#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "experiments/core/files/yaml_input.h"
#include "experiments/data/camera_noise.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

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

template <typename Integer>
std::function<void(const YAML::Node&)> CountReader(const Place& place, const std::string& key,
                                                   NoiseRange allowed, Integer* value) {
  return [=, &place](const YAML::Node& node) {
    const double real = ReadNoiseReal(place, node, key, allowed);
    if (real != std::floor(real)) place.Fail(node, fmt::format("{}: a whole number is needed", key));
    *value = static_cast<Integer>(real);
  };
}

std::vector<double> ReadNoiseReals(const Place& place, const YAML::Node& node, const std::string& key,
                                   size_t size, NoiseRange allowed) {
  if (!node.IsSequence() || node.size() != size)
    place.Fail(node, fmt::format("{}: a list of {} numbers is needed", key, size));
  std::vector<double> values;
  for (const YAML::Node& value : node) values.push_back(ReadNoiseReal(place, value, key, allowed));
  return values;
}

// Reads a map in which each of these keys occurs once; some may be missing.
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

ValueWithError ReadValueWithError(const Place& place, const YAML::Node& node, const std::string& key,
                                  NoiseRange allowed) {
  ValueWithError measured;
  ReadNoiseMap(place, node, key,
               {{"value", RealReader(place, key, allowed, &measured.value)},
                {"standard_error", RealReader(place, key, kAnySize, &measured.standard_error)}});
  return measured;
}

void ReadEvidence(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  ReadNoiseMap(
      place, node, "rests_on",
      {{"pairs", CountReader(place, "pairs", {1, 1e9}, &noise->num_pairs)},
       {"matches", CountReader(place, "matches", {1, 1e15}, &noise->num_matches)},
       {"effective_pairs", RealReader(place, "effective_pairs", kAnySize, &noise->effective_pairs)},
       {"estimator", [&](const YAML::Node& text) { noise->estimator = Name(place, text, "estimator"); }}});
}

void ReadNoiseCamera(const Place& place, const YAML::Node& node, Camera* camera) {
  constexpr NoiseRange kSide = {1, 1e6}, kFocal = {1e-3, 1e9}, kCentre = {-1e9, 1e9};
  ReadNoiseMap(place, node, "camera",
               {{"width", CountReader(place, "width", kSide, &camera->width)},
                {"height", CountReader(place, "height", kSide, &camera->height)},
                {"fx", RealReader(place, "fx", kFocal, &camera->fx)},
                {"fy", RealReader(place, "fy", kFocal, &camera->fy)},
                {"cx", RealReader(place, "cx", kCentre, &camera->cx)},
                {"cy", RealReader(place, "cy", kCentre, &camera->cy)}});
}

void ReadDisplacement(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  ReadNoiseMap(place, node, "displacement_field",
               {{"sd_px", RealReader(place, "sd_px", {1e-9, kMostPx}, &noise->displacement_px.value)},
                {"standard_error",
                 RealReader(place, "standard_error", kAnySize, &noise->displacement_px.standard_error)},
                {"reach_px", RealReader(place, "reach_px", {0.1, 1e5}, &noise->reach_px)},
                {"reach_factor", RealReader(place, "reach_factor", {1.0, 1e12}, &noise->reach_factor)}});
}

void ReadUnseen(const Place& place, const YAML::Node& node, CameraNoise* noise) {
  ReadNoiseMap(place, node, "unseen_field",
               {{"sd_px", RealReader(place, "sd_px", {1e-9, kMostPx}, &noise->unseen_px)},
                {"reach_px", RealReader(place, "reach_px", {0.1, 1e5}, &noise->unseen_reach_px)}});
}

CameraCorrection ReadCorrection(const Place& place, const YAML::Node& node, size_t fault) {
  CameraCorrection correction;
  correction.fault = fault;
  const std::string name = kCorrectableFaults[fault];
  ReadNoiseMap(place, node, name,
               {{"value", RealReader(place, name, kAnyReal, &correction.estimate.value)},
                {"standard_error", RealReader(place, name, kAnySize, &correction.estimate.standard_error)},
                {"removed", RealReader(place, name, {-1e4, 1e4}, &correction.removed)},
                {"uncertainty", RealReader(place, name, kAnySize, &correction.uncertainty)}},
               {"removed"});
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
  YAML::Node dx, dy;
  ReadNoiseMap(place, node, "systematic_displacement",
               {{"columns", CountReader(place, "columns", {1, kMostCells}, &cells->columns)},
                {"rows", CountReader(place, "rows", {1, kMostCells}, &cells->rows)},
                {"rms_px", RealReader(place, "rms_px", {0.0, kMostPx}, &cells->rms_px)},
                {"p_value", RealReader(place, "p_value", {0.0, 1.0}, &cells->p_value)},
                {"dx_px", [&](const YAML::Node& list) { dx.reset(list); }},
                {"dy_px", [&](const YAML::Node& list) { dy.reset(list); }}});
  const auto size = static_cast<size_t>(cells->columns) * static_cast<size_t>(cells->rows);
  cells->dx_px = ReadNoiseReals(place, dx, "dx_px", size, {-kMostPx, kMostPx});
  cells->dy_px = ReadNoiseReals(place, dy, "dy_px", size, {-kMostPx, kMostPx});
}

// Returns whether the matrix is symmetric with ones on the diagonal and no negative eigenvalue, to the
// written digits.
bool IsCorrelationMatrix(const std::vector<double>& values, size_t size) {
  const auto n = static_cast<Eigen::Index>(size);
  const Eigen::MatrixXd matrix = Eigen::Map<const Eigen::MatrixXd>(values.data(), n, n);
  const double slack = 1e-4 * static_cast<double>(size);
  if ((matrix - matrix.transpose()).norm() > slack ||
      (matrix.diagonal().array() - 1.0).matrix().norm() > slack)
    return false;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(matrix, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues()(0) >= -slack;
}

// Reads the correlations of `num_faults` faults; the key is absent if there are none.
std::vector<double> ReadCorrelations(const Place& place, const YAML::Node& root, const std::string& key,
                                     size_t num_faults) {
  if (num_faults == 0 && !root[key]) return {};
  if (!root[key]) place.Fail(root, fmt::format("noise file: key '{}' is missing", key));
  const std::vector<double> values =
      ReadNoiseReals(place, root[key], key, num_faults * num_faults, {-1.0001, 1.0001});
  if (num_faults > 0 && !IsCorrelationMatrix(values, num_faults))
    place.Fail(root[key],
               fmt::format("{}: a correlation matrix of {} faults is needed, row by row: symmetric, "
                           "ones on its diagonal, no negative eigenvalue",
                           key, num_faults));
  return values;
}

void ReadNoiseVersion(const Place& place, const YAML::Node& node) {
  if (Line(place, node, kNoiseVersionKey) != kNoiseVersion)
    place.Fail(node, fmt::format("{}: this program reads version {}", kNoiseVersionKey, kNoiseVersion));
}

void ReadNoiseKeys(const Place& place, const YAML::Node& root, CameraNoise* noise) {
  using Node = const YAML::Node&;
  const auto later = [](Node) {};  // ReadCorrelations
  const auto measured = [&](const char* key, NoiseRange allowed, ValueWithError* value) {
    return
        [&place, key, allowed, value](Node node) { *value = ReadValueWithError(place, node, key, allowed); };
  };
  ReadNoiseMap(
      place, root, "noise file",
      {{kNoiseVersionKey, [&](Node node) { ReadNoiseVersion(place, node); }},
       {"rests_on", [&](Node node) { ReadEvidence(place, node, noise); }},
       {"camera", [&](Node node) { ReadNoiseCamera(place, node, &noise->camera); }},
       {"sigma_px", measured("sigma_px", {1e-9, kMostPx}, &noise->sigma_px)},
       {"size_exponent", measured("size_exponent", {-10.0, 10.0}, &noise->size_exponent)},
       {"key_point_px", RealReader(place, "key_point_px", {0.0, kMostPx}, &noise->key_point_px)},
       {"displacement_field", [&](Node node) { ReadDisplacement(place, node, noise); }},
       {"unseen_field", [&](Node node) { ReadUnseen(place, node, noise); }},
       {"camera_faults", [&](Node node) { ReadCorrections(place, node, noise); }},
       {"correlations", later},
       {"uncertainty_correlations", later},
       {"seconds_between", RealReader(place, "seconds_between", {1e-9, 1e9}, &noise->seconds_between)},
       {"systematic_displacement", [&](Node node) { ReadSystematic(place, node, &noise->systematic); }}},
      {"size_exponent", "displacement_field", "unseen_field", "camera_faults", "correlations",
       "uncertainty_correlations", "seconds_between", "systematic_displacement"});
}

}  // namespace

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
  ReadNoiseKeys(place, root, &noise);
  noise.correlations = ReadCorrelations(place, root, "correlations", noise.corrections.size());
  noise.uncertainty_correlations =
      ReadCorrelations(place, root, "uncertainty_correlations", noise.corrections.size());
  if (std::hypot(noise.key_point_px, noise.displacement_px.value, noise.unseen_px) >
      1.0001 * noise.sigma_px.value)
    place.Fail(
        root["sigma_px"],
        "sigma_px: key_point_px, displacement_field and unseen_field have more variance than all of it");
  return noise;
}

}  // namespace rcme
