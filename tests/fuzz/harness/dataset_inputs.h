// The readers of downloads, each of one input: what is fuzzed, and mutated in the tests.
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/real/sequences/colmap_model.h"
#include "experiments/real/sequences/layouts.h"
#include "tests/test_support/temp_folder.h"

namespace rcme {

// A folder whose files are the parts of an input, between lines of "====". An input with fewer parts leaves
// the last files empty.
class DatasetInParts {
 public:
  explicit DatasetInParts(std::vector<std::string> files) : files_(std::move(files)) {
    for (const std::string& file : files_)
      std::filesystem::create_directories(std::filesystem::path(folder_.Path(file)).parent_path());
  }
  // The folder, filled anew.
  std::string Filled(std::string_view input) const {
    constexpr std::string_view kBetween = "\n====\n";
    for (const std::string& file : files_) {
      const std::string_view part = input.substr(0, input.find(kBetween));
      std::filesystem::remove(folder_.Path(file));  // some file systems flush a file that is written over
      folder_.Write(file, std::string(part));
      input.remove_prefix(std::min(input.size(), part.size() + kBetween.size()));
    }
    return folder_.path();
  }

 private:
  std::vector<std::string> files_;
  TempFolder folder_;
};

// Calibration, truth, list of images, and two images that it may name.
inline void ReadEurocInput(std::string_view input) {
  static const DatasetInParts dataset({"mav0/cam0/sensor.yaml", "mav0/state_groundtruth_estimate0/data.csv",
                                       "mav0/cam0/data.csv", "mav0/cam0/data/1.png", "mav0/cam0/data/2.png"});
  DatasetOptions options;
  options.folder = dataset.Filled(input);
  ReadEuroc(options);
}

// Calibration, times, poses and two images.
inline void ReadKittiInput(std::string_view input) {
  static const DatasetInParts dataset({"sequences/00/calib.txt", "sequences/00/times.txt", "poses/00.txt",
                                       "sequences/00/image_0/000000.png", "sequences/00/image_0/000001.png"});
  DatasetOptions options;
  options.folder = dataset.Filled(input);
  ReadKitti(options);
}

// Truth, list of images, and two images that it may name.
inline void ReadTumInput(std::string_view input) {
  static const DatasetInParts dataset({"groundtruth.txt", "rgb.txt", "1.png", "2.png"});
  DatasetOptions options;
  options.folder = dataset.Filled(input);
  options.K = {500.0, 500.0, 320.0, 240.0};
  ReadTum(options);
}

// Cameras and images of a reconstruction.
inline void ReadColmapBytesInput(std::string_view input) {
  static const DatasetInParts dataset({"cameras.bin", "images.bin"});
  ReadColmapModel(dataset.Filled(input));
}
inline void ReadColmapTextInput(std::string_view input) {
  static const DatasetInParts dataset({"cameras.txt", "images.txt"});
  ReadColmapModel(dataset.Filled(input));
}

}  // namespace rcme
