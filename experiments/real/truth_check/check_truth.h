// The given truths of folders of pairs, each folder of another front end.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "experiments/data/camera_plausibility.h"
#include "experiments/real/truth_check/truth_evidence.h"

namespace rcme {

// The match files of one pair, by the folders that have one: the name of the file up to .csv is the same.
struct PairFiles {
  std::string pair_id;
  std::vector<std::string> front_ends;  // names of the folders
  std::vector<std::string> paths;
  bool is_direction_weak = false;  // an INDEX.csv says so (match_folder.h)
};
// Every pair of the folders, by pair_id. A folder is called by its own name, or where two have the same by
// the path as given. Throws InputError (match_folder.h); a folder that is given twice is refused.
std::vector<PairFiles> ListPairFiles(const std::vector<std::string>& folders);

struct TruthCheckOptions {
  FailureBounds bounds;
  double sigma_px = 0.5;
  std::uint64_t seed = 1;
  int num_threads = 0;  // 0: one per core
};

struct CheckedPair {
  std::string scene, pair_id;
  bool has_truth = false;
  PairVerdict verdict;
  std::vector<FrontEndEvidence> front_ends;  // none without a truth
  std::vector<CameraDoubt> camera_doubts;
};
// Throws InputError: files that cannot be read, or that state scenes or motions of a pair that differ.
CheckedPair CheckPair(const PairFiles& files, const MotionEstimator& estimator,
                      const TruthCheckOptions& options);
std::vector<CheckedPair> CheckTruths(const std::vector<std::string>& folders,
                                     const MotionEstimator& estimator, const TruthCheckOptions& options);

}  // namespace rcme
