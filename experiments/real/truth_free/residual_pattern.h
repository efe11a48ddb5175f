// Size, tails and correlation of the residuals of several pairs.
#pragma once

#include <vector>

#include "experiments/real/truth_free/residual_correlation.h"

namespace rcme {

struct ResidualPattern {
  double sigma_px = 0.0;    // geometric mean of the estimated noise; NaN if no pair has a motion
  double tail_ratio = 0.0;  // 95 % point over the median of |r| / sigma, all pairs together
  ResidualProducts products;
};

// Sampson distances of the inliers, divided by the noise (EstimateNoise) and by each match's noise scale.
std::vector<double> ResidualSizes(const MotionProblem& problem, const MotionEstimate& estimate);

// Accumulates the pattern over pairs; refusals are skipped.
class PatternSum {
 public:
  void Add(const MotionProblem& problem, const MotionEstimate& estimate);
  ResidualPattern Take() const;

 private:
  double sum_log_sigma_ = 0.0, num_answers_ = 0.0;
  std::vector<double> sizes_;
  ResidualProducts products_;
};

}  // namespace rcme
