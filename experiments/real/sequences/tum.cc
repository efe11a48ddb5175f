#include <fmt/format.h>

#include <array>

#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/layouts.h"
#include "experiments/real/sequences/timed_frames.h"
#include "parameters/input_error.h"

namespace rcme {
namespace {

namespace fs = std::filesystem;

// The truth has 100 Hz, with gaps where the markers were not visible.
constexpr double kLongestTumGapS = 0.05;

// ROS's own calibrations of the colour cameras, from the benchmark's page "File Formats: Intrinsic Camera
// Calibration of the Kinect". Images of freiburg3 were already undistorted.
struct TumCamera {
  const char* name;
  std::array<double, 4> K;         // fx fy cx cy
  std::vector<double> distortion;  // k1 k2 p1 p2 k3
};
const std::vector<TumCamera>& TumCameras() {
  static const std::vector<TumCamera> cameras = {
      {"freiburg1", {517.3, 516.5, 318.6, 255.3}, {0.2624, -0.9531, -0.0054, 0.0026, 1.1633}},
      {"freiburg2", {520.9, 521.0, 325.1, 249.7}, {0.2312, -0.7849, -0.0033, -0.0001, 0.9172}},
      {"freiburg3", {535.4, 539.2, 320.1, 247.6}, {}}};
  return cameras;
}

Lens TumLens(const DatasetOptions& options, const fs::path& folder) {
  if (!options.K.empty()) {
    return MakeLens({options.K[0], options.K[1], options.K[2], options.K[3], 0, 0}, options.lens,
                    options.distortion, "--K, --lens, --distortion");
  }
  for (const TumCamera& known : TumCameras()) {
    if (FolderName(folder).find(known.name) == std::string::npos) continue;
    return MakeLens({known.K[0], known.K[1], known.K[2], known.K[3], 0, 0},
                    known.distortion.empty() ? LensModel::kPinhole : LensModel::kRadtan, known.distortion,
                    known.name);
  }
  throw InputError(
      fmt::format("{}: this layout does not state the camera; give --K (and --lens, --distortion), "
                  "or a folder with freiburg1, freiburg2 or freiburg3 in its name",
                  folder.string()));
}

Sequence TumSequence(const DatasetOptions& options, const fs::path& folder) {
  Sequence sequence;
  sequence.name = options.name + FolderName(folder);
  sequence.lens = TumLens(options, folder);
  TimedFiles files;
  files.images = folder / "rgb.txt";
  files.images_folder = folder;
  files.truth = folder / "groundtruth.txt";
  files.truth_fields = "timestamp tx ty tz qx qy qz qw";
  files.wxyz = {7, 4, 5, 6};
  files.longest_gap_s = kLongestTumGapS;
  AddTimedFrames(options, files, &sequence);
  return sequence;
}

}  // namespace

std::vector<Sequence> ReadTum(const DatasetOptions& options) {
  std::vector<Sequence> sequences;
  for (const fs::path& folder :
       SequenceFolders(options, "rgb.txt",
                       "it lists the colour images of a TUM RGB-D sequence, and no subfolder has it either"))
    sequences.push_back(TumSequence(options, folder));
  return sequences;
}

}  // namespace rcme
