// An estimator's answers to the pairs of a set and to their twins.
#pragma once

#include <cstdint>
#include <vector>

#include "estimator/motion_estimate.h"
#include "experiments/real/truth_free/pair_set.h"

namespace rcme {

struct Answered {
  NamedPair pair;
  MotionEstimate estimate;
  bool IsOk() const { return estimate.status == MotionStatus::kOk; }
};

struct PairAnswers {
  Answered whole;
  std::vector<Answered> twins;  // empty if the pair itself has no motion
};

// Numbers the images of each pair for stats/shared_members.h. A pair that does not name its images has one
// number of its own for both.
struct ImageNumbers {
  std::int64_t image1 = 0, image2 = 0;
};
std::vector<ImageNumbers> NumberImages(const std::vector<PairAnswers>& answers);

}  // namespace rcme
