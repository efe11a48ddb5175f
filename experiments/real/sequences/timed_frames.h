// For layouts with a file of image names and times, and a file of poses at other times.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

struct TimedFiles {
  TableFile::Separator separator = TableFile::Separator::kSpace;  // of both files
  double seconds_per_unit = 1.0;                                  // of the times in both files

  std::filesystem::path images;         // rows: time, name of an image
  std::string images_origin;            // where to get a missing file
  std::filesystem::path images_folder;  // names are relative to it

  std::filesystem::path truth;   // rows: time, position, quaternion, ... of a body; optional
  std::string truth_fields;      // names in the data set
  std::array<size_t, 4> wxyz{};  // fields of the quaternion
  CameraPose body_from_cam;      // X_body = R X_cam + center
  double longest_gap_s = 0.0;    // limit of the interval between two poses for interpolation
};

// Adds frames, each with the interpolated true pose at its time, and finishes the sequence (FinishSequence).
// Throws InputError.
void AddTimedFrames(const DatasetOptions& options, const TimedFiles& files, Sequence* sequence);

}  // namespace rcme
