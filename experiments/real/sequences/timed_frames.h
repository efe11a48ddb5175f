// Layouts that list images with their times in one file and where something was, at other times, in another.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "experiments/real/sequences/layout_files.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

struct TimedFiles {
  TableFile::Separator separator = TableFile::Separator::kSpace;  // of both files
  double seconds_per_unit = 1.0;                                  // of their times

  std::filesystem::path images;         // rows: time, name of an image
  std::string images_origin;            // where a missing one comes from
  std::filesystem::path images_folder;  // what the names are relative to

  std::filesystem::path truth;   // rows: time, position, quaternion, ... of a body; need not be there
  std::string truth_fields;      // as the data set calls them
  std::array<size_t, 4> wxyz{};  // the quaternion's fields
  CameraPose body_from_cam;      // X_body = R X_cam + center
  double longest_gap_s = 0.0;    // between two rows of the truth that a pose is taken between
};

// Fills in frames, each with the pose that the truth has at its time, and finishes the sequence
// (FinishSequence). Throws InputError.
void AddTimedFrames(const DatasetOptions& options, const TimedFiles& files, Sequence* sequence);

}  // namespace rcme
