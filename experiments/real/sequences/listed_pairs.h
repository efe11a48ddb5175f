// Data sets that already contain matches: gives their pairs one after another.
#pragma once

#include <filesystem>
#include <limits>
#include <memory>
#include <string>

#include "experiments/data/match_file.h"
#include "experiments/real/sequences/sequence.h"

namespace rcme {

struct ListedPair {
  MatchFile file;  // in pixels of undistorted cameras; with truth if there is one
  double baseline = std::numeric_limits<double>::quiet_NaN();  // of the true motion; NaN: not known
  bool is_direction_weak = false;                              // stated by the data set
};

class ListedPairs {
 public:
  virtual ~ListedPairs() = default;
  virtual size_t size() const = 0;
  virtual std::string PairId(size_t i) const = 0;  // the name of its match file
  virtual ListedPair Read(size_t i) = 0;           // throws InputError that names the file
  virtual std::filesystem::path Source(size_t) const {
    return {};
  }  // the pair's own file; empty: it has none
  virtual std::string Note() const { return {}; }
};

// The database of COLMAP (SQLite: cameras, images, keypoints, matches), or the folder that has a
// database.db. Matches are those of the table `matches`, before COLMAP's own verification. The poses of a
// reconstruction (images.txt or images.bin) serve as truth. Its cameras are used too, because they were
// adjusted together with the poses; those of the database are initial guesses. COLMAP's pixel (0.5, 0.5) is
// the centre of the top-left one, so half a pixel is subtracted from key points and principal point.
std::unique_ptr<ListedPairs> OpenColmap(const DatasetOptions& options);

// An HDF5 file of pairs as posebench stores them: a group per pair with x1, x2, R, t, camera1, camera2, read
// one at a time. Cameras and pixels are COLMAP's. Each pair is read in a separate process
// (posebench_file.h), so a file that crashes libhdf5 causes an InputError. Call it only while no other
// thread runs. Throws InputError if the program was built without the library.
std::unique_ptr<ListedPairs> OpenPosebench(const DatasetOptions& options);

// A folder of `.npz` files (npz_file.h), one per pair: `keypoints0` [n0, 2] and `keypoints1` [n1, 2] in px,
// where (0, 0) is the centre of the first pixel. The matches are `matches` [n0] (key point of image 2, or
// -1) with `match_confidence` or `matching_scores` [n0]; or `matches` [m, 2] with `scores` [m]; or, without
// `matches`, `matches0` and `matching_scores0` [n0]. Scores may be missing. Both images have the camera of
// --K.
std::unique_ptr<ListedPairs> OpenNpzPairs(const DatasetOptions& options);

// A folder of match files (match_file.h).
std::unique_ptr<ListedPairs> OpenMatchFiles(const DatasetOptions& options);

}  // namespace rcme
