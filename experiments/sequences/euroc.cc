#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

#include "experiments/base/yaml_input.h"
#include "experiments/sequences/layout_files.h"
#include "experiments/sequences/layouts.h"
#include "parameters/input_error.h"
#include "parameters/parameter.h"
#include "parameters/plain_text.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// The truth is at 200 Hz.
constexpr double kMaxEurocGapS = 0.1;

struct EurocSensor {
  Lens lens;
  CameraPose body_from_cam;  // T_BS
};

// The numbers of a list in sensor.yaml.
std::vector<double> ListOf(const Place& place, const YAML::Node& map, const std::string& key, size_t least) {
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
  const std::vector<double> K = ListOf(place, root, "intrinsics", 4),
                            size = ListOf(place, root, "resolution", 2);
  for (const double length : size) {
    if (!(length >= 1.0 && length <= 1e6 && length == std::floor(length)))
      place.Fail(root["resolution"], "resolution: whole numbers in [1, 1e6] are needed");
  }
  EurocSensor sensor;
  sensor.lens =
      MakeLens({K[0], K[1], K[2], K[3], static_cast<int>(size[0]), static_cast<int>(size[1])},
               EurocLensModel(place, root), ListOf(place, root, "distortion_coefficients", 4), path.string());
  const YAML::Node extrinsics = root["T_BS"];
  if (!extrinsics.IsDefined()) place.Fail(root, "T_BS: is missing; the truth is that of the body");
  const std::vector<double> T = ListOf(place, extrinsics, "data", 16);
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

// Rows: time in ns, position, quaternion w x y z, ... of the body.
Trajectory ReadBody(const fs::path& path, const CameraPose& body_from_cam) {
  Trajectory trajectory;
  for (TableFile table(path, "", TableFile::Separator::kComma); table.Next();) {
    table.Need(8, "timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z, ...");
    const Eigen::Matrix3d R = RotationFromFields(table, 4, 5, 6, 7);
    const Eigen::Vector3d p(table.Number(1), table.Number(2), table.Number(3));
    if (!trajectory.Add(1e-9 * table.Number(0),
                        {R * body_from_cam.R_world_from_cam, R * body_from_cam.center + p}))
      table.Fail("the time is not after that of the row before; times must grow");
  }
  return trajectory;
}

Sequence EurocSequence(const DatasetOptions& options, const fs::path& folder) {
  const fs::path cam0 = folder / "mav0" / "cam0",
                 truth = folder / "mav0" / "state_groundtruth_estimate0" / "data.csv";
  const EurocSensor sensor = ReadSensor(cam0 / "sensor.yaml");
  Sequence sequence;
  sequence.name = options.name + FolderName(folder);
  sequence.lens = sensor.lens;
  Trajectory trajectory;
  if (fs::exists(truth)) {
    trajectory = ReadBody(truth, sensor.body_from_cam);
  } else {
    sequence.note = fmt::format("no truth: {} is not there", truth.string());
  }
  for (TableFile table(cam0 / "data.csv", "it names the images with their times",
                       TableFile::Separator::kComma);
       table.Next();) {
    table.Need(2, "timestamp, filename");
    const double time_s = 1e-9 * table.Number(0);
    const std::string name = table.fields()[1];
    sequence.frames.push_back(
        {name, (cam0 / "data" / name).string(), time_s, trajectory.At(time_s, kMaxEurocGapS)});
  }
  FinishSequence(options, cam0 / "data.csv", &sequence);
  return sequence;
}

}  // namespace

std::vector<Sequence> ReadEuroc(const DatasetOptions& options) {
  std::vector<Sequence> sequences;
  for (const fs::path& folder : SequenceFolders(
           options, "mav0",
           "the archives of EuRoC (ASL format) unpack to mav0, no folder in this one has it either"))
    sequences.push_back(EurocSequence(options, folder));
  return sequences;
}

}  // namespace rcme
