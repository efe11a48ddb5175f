// Whether two-view covariances predict how well rotations close around longer and longer loops.
#pragma once

#include <cstdint>
#include <vector>

#include "experiments/core/table/table.h"
#include "experiments/real/truth_free/closure.h"
#include "experiments/real/truth_free/pair_answers.h"

namespace rcme {

inline constexpr size_t kMostLoopImages = 50;

// What loops of one length say. The squared distances of the rotations' closures, under covariances that are
// propagated around the loop, are chi-square with three degrees of freedom where the covariances hold.
struct LengthClosure {
  size_t num_images = 0;
  bool is_of_twins = false;  // of the simulated twins of the pairs
  SharedErrors shared = SharedErrors::kAllowedFor;
  std::int64_t num_loops = 0;  // that are closed; of twins: times their number
  std::int64_t num_apart = 0;  // of which no two share an image
  Estimate covered;            // share within the 95 % region
  Estimate rms_over_sd;        // root of the mean of the squared distance over three: 1 is right
};

// Of lengths 3 to `longest` that have a loop (FindLoopsOfLength) whose pairs are all answered: four entries
// each, of the pairs and of their twins (none where there are none), shared errors allowed for and ignored.
// 95 % intervals that allow for loops that share an image (MeasureSharedGroupMean).
std::vector<LengthClosure> MeasureClosureByLength(const std::vector<PairAnswers>& answers, size_t longest);

}  // namespace rcme
