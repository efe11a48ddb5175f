// The common form into which all layouts are read: image sequences with a camera, times and, if known,
// poses. It has only names and poses; images are read later, one at a time.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "estimator/geometry/lens.h"
#include "experiments/real/sequences/trajectory.h"

namespace rcme {

struct Frame {
  std::string name;  // of its image within the sequence
  std::string path;
  double time_s = std::numeric_limits<double>::quiet_NaN();  // NaN: not stated by the data set
  std::optional<CameraPose> pose_true;
  std::string why_skipped = {};  // a sentence that begins with the path; empty: not skipped
};

struct Sequence {
  std::string name;
  Lens lens;
  std::vector<Frame> frames;
  std::string note;  // for people: what is missing, or empty
};

// Which part of a data set to read, and what it does not state itself.
struct DatasetOptions {
  std::string folder;
  std::vector<std::string> only;  // names of sequences as in their folders; empty: all
  std::string name;               // prefix or replacement of a sequence's name; empty: the layout's
  std::vector<double> K;          // fx fy cx cy, px; empty: as in the data set
  LensModel lens = LensModel::kPinhole;
  std::vector<double> distortion;
  // colmap: folder of a reconstruction; empty: sparse/0 beside the database, if it exists.
  std::string model;
  int max_frames = 0;  // use only the first frames of each sequence; 0: all
};

}  // namespace rcme
