// Tests whether two-view covariances predict the rotation closure errors of loops of growing length.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/real/truth_free/closure.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

inline constexpr size_t kMostLoopImages = 50;

// Result for loops of one length. If the covariances hold, the squared rotation closure error, normalised by
// the covariance propagated around the loop, is chi-square with three degrees of freedom.
struct LengthClosure {
  size_t num_images = 0;
  bool is_of_twins = false;  // of the simulated twins of the pairs
  SharedErrors shared = SharedErrors::kAllowedFor;
  std::int64_t num_loops = 0;  // evaluated; for twins one per loop and twin
  std::int64_t num_apart = 0;  // loops among these of which no two share an image
  Estimate covered;            // share within the 95 % region
  Estimate rms_over_sd;        // sqrt(mean squared distance / 3); 1 if the covariances hold
};

// Entries for each length from 3 to `longest` that has a loop (FindLoopsOfLength) with an estimate for every
// pair: pairs and twins (if there are any), each with shared errors allowed for and ignored. The 95 %
// intervals account for loops that share an image (MeasureSharedGroupMean).
std::vector<LengthClosure> MeasureClosureByLength(const std::vector<PairAnswers>& answers, size_t longest);

}  // namespace rcme
