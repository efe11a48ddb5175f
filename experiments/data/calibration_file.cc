#include "experiments/data/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "experiments/data/match_file.h"
#include "parameters/input_error.h"
#include "parameters/settings.h"
#include "simulator/camera_registry.h"

namespace rcme {
namespace {

constexpr const char* kCameras = "own_intrinsics";

void AddIntrinsics(const std::string& number, const Camera& camera, Settings* settings) {
  const std::pair<std::string, double> values[] = {
      {"fx" + number + "_px", camera.fx},          {"fy" + number + "_px", camera.fy},
      {"cx" + number + "_px", camera.cx},          {"cy" + number + "_px", camera.cy},
      {"image" + number + "_width", camera.width}, {"image" + number + "_height", camera.height}};
  for (const auto& [key, value] : values) settings->emplace_back(key, fmt::format("{}", value));
}

Settings IntrinsicsIn(const std::string& path) {
  const MatchFile file = ReadMatchFile(path);
  if (file.undistortion) {
    throw InputError(fmt::format(
        "{}: camera1, camera2: a lens is not allowed here; give K, or a study with cameras: radtan "
        "or fisheye",
        path));
  }
  InputWarnings warnings;
  warnings.Add(file.doubts);
  warnings.Print();
  Settings intrinsics;
  AddIntrinsics("1", file.camera1, &intrinsics);
  AddIntrinsics("2", file.camera2, &intrinsics);
  const auto model = FindEntry(CameraRegistry(), "cameras", kCameras).make();
  const std::vector<Parameter> parameters = model->Parameters();
  try {
    for (const auto& [key, value] : intrinsics) FindParameter(parameters, key).SetFromText(value);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", path, error.what()));
  }
  return intrinsics;
}

}  // namespace

SettingHelp CalibrationHelp() {
  return {kCalibrationKey, "", "",
          "a file with the header lines of a match file: # size1: w h, # K1_fx_fy_cx_cy: ..., and 2",
          "path seen from the study's folder"};
}

Settings WithCalibration(const Settings& settings) {
  if (FindSetting(settings, "cameras") != kCamerasFromFile) return settings;
  const std::string path = FindSetting(settings, kCalibrationKey).value_or("");
  if (path.empty()) {
    throw InputError(fmt::format("cameras: {} needs the key '{}': {}", kCamerasFromFile, kCalibrationKey,
                                 CalibrationHelp().allowed));
  }
  Settings expanded = {{"cameras", kCameras}};
  for (const Settings& part : {IntrinsicsIn(path), settings}) {
    std::ranges::copy_if(part, std::back_inserter(expanded), [](const auto& setting) {
      return setting.first != "cameras" && setting.first != kCalibrationKey;
    });
  }
  return expanded;
}

}  // namespace rcme
