// What every layout of a data set is read into: image sequences with a camera, times and, where they are
// known, poses. Names and poses only: images are read one at a time, when their turn comes.
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
  double time_s = std::numeric_limits<double>::quiet_NaN();  // NaN: the data set does not say
  std::optional<CameraPose> pose_true;
  std::string why_skipped = {};  // a sentence that begins with the path; empty: it is not
};

struct Sequence {
  std::string name;
  Lens lens;
  std::vector<Frame> frames;
  std::string note;  // for people: what is missing, if something is
};

// Which part of a data set is read, and what it does not say itself.
struct DatasetOptions {
  std::string folder;
  std::vector<std::string> only;  // names of sequences as their folders have them; empty: all
  std::string name;               // before or instead of a sequence's own; empty: the layout's
  std::vector<double> K;          // fx fy cx cy, px; empty: as the data set says
  LensModel lens = LensModel::kPinhole;
  std::vector<double> distortion;
  std::string
      model;  // colmap: folder of a reconstruction; empty: sparse/0 beside the database, if it is there
  int max_frames = 0;  // of each sequence the first; 0: all
};

}  // namespace rcme
