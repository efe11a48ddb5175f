// The pairs of a set and their twins, answered by an estimator.
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
  std::vector<Answered> twins;  // none of a pair that is not answered
};

// The images of each pair as numbers, for stats/shared_members.h; a pair that does not name its images has a
// number of its own, twice.
struct ImageNumbers {
  std::int64_t image1 = 0, image2 = 0;
};
std::vector<ImageNumbers> NumberImages(const std::vector<PairAnswers>& answers);

}  // namespace rcme
