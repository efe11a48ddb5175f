#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "experiments/core/files/yaml_input.h"
#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/layouts.h"
#include "experiments/real/sequences/timed_frames.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// The truth has 200 Hz.
constexpr double kLongestEurocGapS = 0.1;

struct EurocSensor {
  Lens lens;
  CameraPose body_from_cam;  // T_BS
};

// Reads the numbers of a list in sensor.yaml.
std::vector<double> ReadNumberList(const Place& place, const YAML::Node& map, const std::string& key,
                                   size_t least) {
  const YAML::Node list = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
  if (!list.IsDefined() || !list.IsSequence())
    place.Fail(map, fmt::format("{}: a list of numbers is needed", key));
  std::vector<double> numbers;
  for (const YAML::Node& node : list) {
    double number = 0.0;
    const std::string text = Scalar(place, node, key);
    if (!ParseReal(text, &number))
      place.Fail(node, fmt::format("{}: {} is not a finite number", key, Quoted(text)));
    numbers.push_back(number);
  }
  if (numbers.size() < least)
    place.Fail(list, fmt::format("{}: {} numbers; {} are needed", key, numbers.size(), least));
  return numbers;
}

LensModel EurocLensModel(const Place& place, const YAML::Node& root) {
  const std::string name =
      root["distortion_model"] ? Scalar(place, root["distortion_model"], "distortion_model") : "";
  if (name == "radial-tangential" || name == "radtan") return LensModel::kRadtan;
  if (name == "equidistant") return LensModel::kFisheye;
  place.Fail(root, fmt::format("distortion_model: {} is not known; radial-tangential and equidistant are",
                               Quoted(name)));
}

EurocSensor ReadSensor(const fs::path& path) {
  CheckIsThere(path, "it is the camera's calibration");
  const FileKind kind{"sensor file", "a sensor file"};
  const Place place(path.string());
  const YAML::Node root = ParseYaml(ReadInputText(path.string(), kind), path.string(), kind);
  if (!root.IsMap()) place.Fail(root, "keys and values are needed: intrinsics, resolution, T_BS, ...");
  const std::vector<double> K = ReadNumberList(place, root, "intrinsics", 4),
                            size = ReadNumberList(place, root, "resolution", 2);
  for (const double length : size) {
    if (!(length >= 1.0 && length <= 1e6 && length == std::floor(length)))
      place.Fail(root["resolution"], "resolution: whole numbers in [1, 1e6] are needed");
  }
  EurocSensor sensor;
  sensor.lens = MakeLens({K[0], K[1], K[2], K[3], static_cast<int>(size[0]), static_cast<int>(size[1])},
                         EurocLensModel(place, root),
                         ReadNumberList(place, root, "distortion_coefficients", 4), path.string());
  const YAML::Node extrinsics = root["T_BS"];
  if (!extrinsics.IsDefined()) place.Fail(root, "T_BS: is missing; the truth is that of the body");
  const std::vector<double> T = ReadNumberList(place, extrinsics, "data", 16);
  for (size_t i = 0; i < 12; ++i) {
    const auto row = static_cast<int>(i / 4), column = static_cast<int>(i % 4);
    (column < 3 ? sensor.body_from_cam.R_world_from_cam(row, column) : sensor.body_from_cam.center[row]) =
        T[i];
  }
  const Eigen::Matrix3d& R = sensor.body_from_cam.R_world_from_cam;
  if (!((R * R.transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-3) || R.determinant() < 0.0)
    place.Fail(extrinsics, "T_BS: does not begin with a rotation");
  return sensor;
}

Sequence EurocSequence(const DatasetOptions& options, const fs::path& folder) {
  const fs::path cam0 = folder / "mav0" / "cam0";
  const EurocSensor sensor = ReadSensor(cam0 / "sensor.yaml");
  Sequence sequence;
  sequence.name = options.name + FolderName(folder);
  sequence.lens = sensor.lens;
  TimedFiles files;
  files.separator = TableFile::Separator::kComma;
  files.seconds_per_unit = 1e-9;
  files.images = cam0 / "data.csv";
  files.images_origin = "it names the images with their times";
  files.images_folder = cam0 / "data";
  files.truth = folder / "mav0" / "state_groundtruth_estimate0" / "data.csv";
  files.truth_fields = "timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z, ...";
  files.wxyz = {4, 5, 6, 7};
  files.body_from_cam = sensor.body_from_cam;
  files.longest_gap_s = kLongestEurocGapS;
  AddTimedFrames(options, files, &sequence);
  return sequence;
}

}  // namespace

std::vector<Sequence> ReadEuroc(const DatasetOptions& options) {
  std::vector<Sequence> sequences;
  for (const fs::path& folder :
       SequenceFolders(options, "mav0",
                       "the archives of EuRoC (ASL format) unpack to mav0, and no subfolder has it either"))
    sequences.push_back(EurocSequence(options, folder));
  return sequences;
}

}  // namespace rcme
