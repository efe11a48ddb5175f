// The width of the regions that an estimator states. It is printed beside every coverage, because regions
// that are wide enough always cover.
#pragma once

#include <string>

#include "experiments/trial/trial.h"
#include "stats/constants.h"
#include "stats/stream_median.h"

namespace rcme {

// Medians over answers (trial/stated_density.h); NaN: unknown.
struct StatedSharpness {
  double sd_over_crb = kNaN, rotation_sd_deg = kNaN, direction_sd_deg = kNaN;

  bool IsKnown() const;
};

class SharpnessMedians {
 public:
  // A record without a covariance counts for nothing.
  void Add(const TrialRecord& record);
  StatedSharpness Measure() const;

 private:
  StreamMedian sd_over_crb_, rotation_sd_deg_, direction_sd_deg_;
};

// "stated sd 1.3 times the least possible", without a bound "stated sd 0.2 deg of rotation, 1.1 deg of
// direction"; empty: unknown.
std::string DescribeSharpness(const StatedSharpness& sharpness);

}  // namespace rcme
