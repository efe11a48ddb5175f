// Checks the given truths of folders of pairs; each folder is from another front end.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/camera_plausibility.h"
#include "experiments/real/truth_check/truth_evidence.h"

namespace rcme {

// The match files of one pair, from the folders that have one: their file names are equal up to .csv.
struct PairFiles {
  std::string pair_id;
  std::vector<std::string> front_ends;  // names of the folders
  std::vector<std::string> paths;
  bool is_direction_weak = false;  // according to an INDEX.csv (match_folder.h)
};
// Lists every pair of the folders, ordered by pair_id. A folder is called by its own name, or by its given
// path if two have the same name. Throws InputError (match_folder.h), also for a folder that is given twice.
std::vector<PairFiles> ListPairFiles(const std::vector<std::string>& folders);

struct TruthCheckOptions {
  FailureBounds bounds;
  std::optional<double> sigma_px = {};  // the assumed noise level, in place of that of the files
  std::uint64_t seed = 1;
  int num_threads = 0;  // 0: one per core
};

struct CheckedPair {
  std::string scene, pair_id;
  bool has_truth = false;
  PairVerdict verdict;
  std::vector<FrontEndEvidence> front_ends;  // empty without a truth
  std::vector<CameraDoubt> camera_doubts;
};
// Throws InputError if files cannot be read, or if the files of a pair state different scenes or motions.
CheckedPair CheckPair(const PairFiles& files, const MotionEstimator& estimator,
                      const TruthCheckOptions& options);
std::vector<CheckedPair> CheckTruths(const std::vector<std::string>& folders,
                                     const MotionEstimator& estimator, const TruthCheckOptions& options);

}  // namespace rcme
