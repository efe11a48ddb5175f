// Checks the given truths of folders of pairs; each folder is from another front end.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "experiments/data/input_doubt.h"
#include "experiments/real/truth_check/truth_evidence.h"

namespace rcme {

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
  std::vector<InputDoubt> camera_doubts;
};
// Checks every pair of the folders, ordered by pair_id. The match files of a pair have file names that are
// equal up to .csv. A folder is called by its own name, or by its given path if two have the same name.
// Throws InputError if files cannot be read (match_folder.h), if a folder is given twice, or if the files of
// a pair state different scenes or motions.
std::vector<CheckedPair> CheckTruths(const std::vector<std::string>& folders,
                                     const MotionEstimator& estimator, const TruthCheckOptions& options);

}  // namespace rcme
